// SPDX-License-Identifier: Apache-2.0
#include "integrators/shift.h"

namespace vernier {
namespace {

/// Lobes narrower than this show from where a path came to them.
constexpr float least_broad_alpha = 0.15f;

}  // namespace

Rgb loss_along(const Scene& scene, const Segment& segment, const std::optional<Interaction>& hit) {
  return transmittance(
      scene.volumes().stretch(segment.media, segment.ray, 0, hit ? hit->t : segment.ray.t_max));
}

bool Shift::is_broad(const Shading& surface) {
  const SpecularRays rays = surface.specular().rays;
  if (rays.alpha >= least_broad_alpha) return true;
  return luminance(rays.reflected + rays.transmitted) <= 0.5f * luminance(surface.albedo());
}

void Shift::begin(const Scene& scene, const Ray& ray, const Ray& base, RayCounts& rays) {
  if (ray.time != base.time) return;
  segment_ = camera_segment(scene, ray);
  hit_ = intersect_from_camera(scene, segment_);
  ++rays.camera;
  if (!hit_) return;
  throughput_ = camera_response(scene, segment_) * loss_along(scene, segment_, hit_);
  surface_.emplace(shade(scene, *hit_, -segment_.ray.direction, throughput_));
  state_ = is_black(throughput_) ? State::dead : State::separate;
}

Rgb Shift::emission(const Scene& scene, const LightEval& base, bool base_is_delta) const {
  if (state_ == State::merged)
    return throughput_ * base.radiance * emission_weight(base_is_delta, pdf_, base.pdf);
  if (is_narrow_) return {0, 0, 0};
  const LightEval light = scene.emitted(is_delta_ ? nullptr : &*from_, segment_.ray, hit_ ? &*hit_ : nullptr);
  return throughput_ * light.radiance * emission_weight(is_delta_, pdf_, light.pdf);
}

void Shift::follow(const Scene& scene, const PathStep& step, const PathSurvival& survival, RayCounts& rays) {
  Rgb loss = step.loss;
  if (!is_separate()) {
    if (!follow_shared(step)) return end();
  } else {
    loss = step.can_be_joined ? join(scene, step, rays) : replay(scene, step, rays);
    if (is_dead()) return;
  }
  // With the other probability it would have survived as a path of its own pixel; what is lost on the way
  // counts after that, as it does for the base path.
  const float own =
      survival.is_at_risk ? roulette_survival(throughput_ * (eta_scale_ / ratio_), survival.vertex) : 1;
  ratio_ *= own / survival.probability;
  throughput_ *= loss / survival.probability;
  if (is_black(throughput_) || single_live_channel(throughput_) != single_live_channel(step.throughput))
    end();
}

/// On from a vertex of the base path in the same direction.
bool Shift::follow_shared(const PathStep& step) {
  const ShadingSample& next = step.next;
  if (state_ == State::joined) {
    const BsdfEval scattered = surface_->eval(next.wi);
    if (next.is_delta || is_black(scattered.f_cos) || !(scattered.pdf > 0)) return false;
    throughput_ *= scattered.f_cos / next.pdf;
    ratio_ *= scattered.pdf / next.pdf;
    pdf_ = scattered.pdf;
    state_ = State::merged;
  } else {
    throughput_ *= next.weight;
    if (!next.is_straight) pdf_ = next.pdf;
  }
  eta_scale_ *= next.eta * next.eta;
  is_narrow_ = false;
  return true;
}

/// To the vertex that the base path has come to, or out of the scene in its direction. Returns what gets
/// there.
Rgb Shift::join(const Scene& scene, const PathStep& step, RayCounts& rays) {
  state_ = State::dead;
  const Interaction at = *hit_;
  const std::optional<Interaction>& target = step.hit;
  Vec3f wi = step.segment.ray.direction;
  float jacobian = 1;
  if (target) {
    const Vec3f way = target->position - at.position, base_way = target->position - step.from.position;
    const float distance2 = length_squared(way), base_distance2 = length_squared(base_way);
    if (!(distance2 > 0 && base_distance2 > 0)) return {0, 0, 0};
    wi = way / std::sqrt(distance2);
    const float cosine = dot(wi, target->ng),
                base_cosine = dot(base_way, target->ng) / std::sqrt(base_distance2);
    if (!(cosine * base_cosine > 0)) return {0, 0, 0};
    if (at.toward(wi).current() != target->before.current()) return {0, 0, 0};
    jacobian = cosine / base_cosine * (base_distance2 / distance2);
  }
  const BsdfEval scattered = surface_->eval(wi);
  if (surface_->is_transmitted(wi) || is_black(scattered.f_cos)) return {0, 0, 0};
  if (!(scattered.pdf > 0 && !is_narrow(false, scattered.pdf))) return {0, 0, 0};
  Segment way = at.spawn(wi);
  if (target)
    way.ray = at.SurfacePoint::spawn_to(target->position, target->error, target->ng, target->triangle());
  ++rays.shadow;
  const Passage passage = transmittance(scene, way);
  if (passage.surfaces > 0 || passage.is_bent || is_black(passage.fraction)) return {0, 0, 0};
  throughput_ *= scattered.f_cos * (jacobian / step.next.pdf);
  if (target) {
    surface_.emplace(shade(scene, *target, -wi, throughput_ * passage.fraction));
    if (!is_broad(*surface_)) return {0, 0, 0};
  }
  ratio_ *= scattered.pdf * jacobian / step.next.pdf;
  from_ = at;
  pdf_ = scattered.pdf;
  is_delta_ = is_narrow_ = false;
  segment_ = way;
  segment_.ray.direction = wi;
  hit_ = target;
  state_ = State::joined;
  return passage.fraction;
}

/// By the same random numbers as the base path. Returns what gets to where that leads.
Rgb Shift::replay(const Scene& scene, const PathStep& step, RayCounts& rays) {
  state_ = State::dead;
  const auto next = surface_->sample(step.lobe_choice, step.direction);
  if (!next || is_black(next->weight)) return {0, 0, 0};
  throughput_ *= next->weight;
  eta_scale_ *= next->eta * next->eta;
  is_narrow_ = is_narrow_ && is_narrow(next->is_delta, next->pdf);
  if (!next->is_straight) {
    from_ = *hit_;
    pdf_ = next->pdf;
    is_delta_ = next->is_delta;
  }
  segment_ = hit_->spawn(next->wi);
  hit_ = intersect(scene, segment_);
  ++rays.bounce;
  const Rgb loss = loss_along(scene, segment_, hit_);
  if (hit_) surface_.emplace(shade(scene, *hit_, -segment_.ray.direction, throughput_ * loss));
  // As a base path it would have been joined there.
  if (is_broad(*next) && (!hit_ || is_broad(*surface_))) return {0, 0, 0};
  state_ = State::separate;
  return loss;
}

}  // namespace vernier
