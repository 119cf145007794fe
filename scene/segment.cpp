// SPDX-License-Identifier: Apache-2.0
#include "scene/segment.h"

#include "scene/accel/query.h"

namespace vernier {
namespace {

/// Lobes of bending glass narrower than this let no lamp be found by chance.
constexpr float narrow_alpha = 0.01f;

/// Distance along a ray, in its parameter, within which a surface may lie where `point` was found.
float uncertainty(const Ray& ray, const SurfacePoint& point) {
  const float across = std::abs(dot(ray.direction, point.ng));
  const float along_normal = dot(abs(point.ng), point.error);
  return across > 0 ? std::min(4 * along_normal / across, 1e-3f * point.t) : 0;
}

/// Boundaries that a ray crosses at one place, as a whole.
class Crossing {
 public:
  Crossing(const Scene& scene, const MediumStack& before) : scene_(scene), before_(before) {}

  void add(const SurfacePoint& point) {
    crossed_.add(point.triangle());
    const uint32_t volume = scene_.volumes().of_instance(point.instance);
    // Of those at one place the boundary of the innermost volume is the one that is seen.
    if (volume_ == MediumStack::air || volume > volume_) {
      volume_ = volume;
      point_ = point;
    }
    // The triangles of one volume that share an edge are crossed once, or grazed.
    const int step = scene_.volumes().is_met_from_outside(point) ? 1 : -1;
    for (size_t i = 0; i < size_; ++i)
      if (net_[i].volume == volume) {
        net_[i].step = std::clamp(net_[i].step + step, -1, 1);
        return;
      }
    if (size_ < net_.size()) net_[size_++] = {volume, step};
  }

  Interaction interaction() const {
    Interaction result{point_, before_, before_, crossed_};
    for (size_t i = 0; i < size_; ++i)
      if (net_[i].step < 0) result.beyond.leave(net_[i].volume);
    for (size_t i = 0; i < size_; ++i)
      if (net_[i].step > 0) result.beyond.enter(net_[i].volume);
    return result;
  }

 private:
  struct Net {
    uint32_t volume;
    int step;
  };

  const Scene& scene_;
  const MediumStack& before_;
  SurfacePoint point_;
  uint32_t volume_ = MediumStack::air;
  CrossedTriangles crossed_;
  size_t size_ = 0;
  std::array<Net, 4> net_;
};

/// Later hits only: by a bit at least, as accelerators that round may find one at t_min.
void go_on_from(Ray& ray, float t) { ray.t_min = std::max(t, next_float_up(ray.t_min)); }

bool bounds_volume(const Scene& scene, uint32_t instance) {
  return scene.volumes().of_instance(instance) != MediumStack::air;
}

/// Whether the medium, and so the light, changes there.
bool is_visible(const Scene& scene, const Interaction& at) {
  return at.before.current() != at.beyond.current() || scene.material(at).is_emissive();
}

/// All that lies where `first`, a volume's boundary, was met.
Interaction interaction_at(const Scene& scene, const Segment& segment, const SurfacePoint& first) {
  Crossing crossing(scene, segment.media);
  crossing.add(first);
  Ray near = segment.ray;
  const float window = uncertainty(near, first);
  near.t_min = std::max(near.t_min, first.t - window);
  near.t_max = std::min(near.t_max, first.t + window);
  thread_local std::vector<RawHit> hits;
  scene.accelerator().all_hits(near, hits);
  for (const RawHit& hit : hits) {
    const SurfacePoint point = scene.geometry().surface_point(near, hit);
    if (point.triangle() == first.triangle() || segment.crossed.contains(point.triangle())) continue;
    if (bounds_volume(scene, hit.instance)) {
      crossing.add(point);
    } else if (!scene.material(point).transmits()) {
      return {point, segment.media, segment.media, {}};
    }
  }
  return crossing.interaction();
}

/// Whether light notices a surface within a medium, whatever the medium is.
bool is_plain(const Scene& scene, const SurfacePoint& point, bool from_camera) {
  return !bounds_volume(scene, point.instance) &&
         (!from_camera || scene.material(point).is_seen(point.front));
}

/// The first surface that light notices, where `point` is the first of all.
std::optional<Interaction> intersect_beyond(const Scene& scene, Segment segment,
                                            std::optional<SurfacePoint> point, bool from_camera) {
  Ray& ray = segment.ray;
  for (; point; point = scene.intersect(ray)) {
    if (is_plain(scene, *point, from_camera)) return Interaction{*point, segment.media, segment.media, {}};
    if (!bounds_volume(scene, point->instance)) {
      // Go on behind the invisible side. Starting beyond the hit's own error keeps the parameter t of the
      // first ray.
      const float error = max_component(point->error) / length(ray.direction);
      go_on_from(ray, std::max(next_float_up(point->t), point->t + 2 * error));
    } else if (segment.crossed.contains(point->triangle())) {
      go_on_from(ray, point->t);
    } else {
      const Interaction at = interaction_at(scene, segment, *point);
      if (is_visible(scene, at)) return at;
      segment.media = at.beyond;
      segment.crossed = at.crossed;
      go_on_from(ray, at.t);
    }
  }
  return std::nullopt;
}

/// Nearly always the first surface of all is noticed, and nothing of the segment need be copied.
std::optional<Interaction> intersect(const Scene& scene, const Segment& segment, bool from_camera) {
  const auto point = scene.intersect(segment.ray);
  if (!point) return std::nullopt;
  if (is_plain(scene, *point, from_camera)) return Interaction{*point, segment.media, segment.media, {}};
  return intersect_beyond(scene, segment, point, from_camera);
}

/// Fraction of light that a surface lets pass straight on; if it is bent there, what passes bent.
Rgb passing(const Scene& scene, const Interaction& at, const Vec3f& direction, Passage& passage) {
  const Shading surface = shade(scene, at, -direction);
  const Rgb straight = surface.straight();
  if (!is_black(straight)) return straight;
  const SpecularRays rays = surface.specular().rays;
  if (rays.alpha > narrow_alpha) return {0, 0, 0};
  passage.is_bent = true;
  passage.is_sharp = passage.is_sharp && rays.alpha == 0;
  passage.has_normal_map = passage.has_normal_map || scene.material(at).has_normal_maps();
  return rays.transmitted;
}

}  // namespace

Segment camera_segment(const Scene& scene, const Ray& ray) {
  Segment segment{ray};
  if (scene.volumes().empty() || !scene.volumes().may_contain(ray.origin)) return segment;
  // A volume that the ray leaves once more often than it enters it is one that it began in.
  std::vector<RawHit> hits;
  scene.accelerator().all_hits(ray, hits);
  std::vector<std::pair<uint32_t, int>> left;
  for (const RawHit& hit : hits) {
    const uint32_t volume = scene.volumes().of_instance(hit.instance);
    if (volume == MediumStack::air) continue;
    const auto same = [&](const auto& entry) { return entry.first == volume; };
    auto entry = std::find_if(left.begin(), left.end(), same);
    if (entry == left.end()) entry = left.insert(left.end(), {volume, 0});
    entry->second += scene.volumes().is_met_from_outside(scene.geometry().surface_point(ray, hit)) ? -1 : 1;
  }
  for (const auto& [volume, times] : left)
    for (int i = 0; i < times; ++i) segment.media.enter(volume);
  return segment;
}

std::optional<Interaction> intersect(const Scene& scene, const Segment& segment) {
  return intersect(scene, segment, false);
}

std::optional<Interaction> intersect_from_camera(const Scene& scene, const Segment& segment) {
  return intersect(scene, segment, true);
}

Passage transmittance(const Scene& scene, const Segment& segment) {
  const Ray& ray = segment.ray;
  thread_local std::vector<RawHit> clear;
  clear.clear();
  if (scene.accelerator().occluded(ray, clear)) return {};
  if (clear.empty() && scene.volumes().are_clear()) return {{1, 1, 1}};
  sort_hits(clear);

  Passage passage{{1, 1, 1}};
  MediumStack media = segment.media;
  float t = 0;
  const float scale = length(ray.direction);
  const Vec3f direction = ray.direction * (1 / scale);
  for (size_t i = 0; i < clear.size();) {
    const SurfacePoint point = scene.geometry().surface_point(ray, clear[i++]);
    if (segment.crossed.contains(point.triangle())) continue;
    Interaction at{point, media, media, {}};
    if (bounds_volume(scene, point.instance)) {
      Crossing crossing(scene, media);
      crossing.add(point);
      const float last = point.t + uncertainty(ray, point);
      for (; i < clear.size() && clear[i].t <= last && bounds_volume(scene, clear[i].instance); ++i)
        crossing.add(scene.geometry().surface_point(ray, clear[i]));
      at = crossing.interaction();
      if (!is_visible(scene, at)) {
        media = at.beyond;
        continue;
      }
    }
    passage.fraction *= transmittance(scene.volumes().stretch(media, ray, t, point.t), scale);
    passage.fraction *= passing(scene, at, direction, passage);
    if (is_black(passage.fraction)) return {};
    ++passage.surfaces;
    media = at.beyond;
    t = point.t;
  }
  passage.fraction *= transmittance(scene.volumes().stretch(media, ray, t, ray.t_max), scale);
  return passage;
}

std::optional<int> single_live_channel(const Rgb& throughput) {
  for (int c = 0; c < 3; ++c)
    if (throughput[c] != 0 && throughput[(c + 1) % 3] == 0 && throughput[(c + 2) % 3] == 0) return c;
  return std::nullopt;
}

Shading shade(const Scene& scene, const Interaction& at, const Vec3f& wo, const Rgb& throughput) {
  if (at.is_in_medium())
    return {Frame::from_normal(wo), wo, wo, HenyeyGreenstein{scene.volumes().medium(at.before).anisotropy}};
  BsdfContext context{.front = at.front};
  if (!at.before.empty() || !at.beyond.empty() || bounds_volume(scene, at.instance)) {
    context.channel = single_live_channel(throughput);
    context.front = scene.volumes().is_met_from_outside(at);
    context.outside_ior = scene.volumes().medium(context.front ? at.before : at.beyond).ior;
  }
  return scene.shade(at, wo, context);
}

}  // namespace vernier
