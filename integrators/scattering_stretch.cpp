// SPDX-License-Identifier: Apache-2.0
#include "integrators/scattering_stretch.h"

namespace vernier {
namespace {

/// How far from its end a segment's vertices must stay so that rounding puts none of them on the other side
/// of the surface there, where the medium is another.
float margin(const Segment& segment, const Interaction& hit) {
  const Vec3f size = abs(hit.position) + abs(segment.ray.origin);
  const float across = std::abs(dot(hit.ng, segment.ray.direction));
  return 0x1p-22f * max_component(size) / std::max(across, 0x1p-10f);
}

}  // namespace

ScatteringStretch::ScatteringStretch(const Scene& scene, const Segment& segment, const Stretch& stretch,
                                     const std::optional<Interaction>& hit, const Rgb& throughput)
    : scene_(scene),
      segment_(segment),
      begin_(stretch.begin),
      length_(stretch.end - stretch.begin),
      flight_(stretch.medium, throughput, length_) {
  const float last = hit ? std::min(stretch.end, hit->t - margin(segment, *hit)) : stretch.end;
  length_ = std::max(last - begin_, 0.f);
  // Lamps beyond a boundary that bends are not seen from inside.
  const bool is_seen_straight = stretch.medium.ior == Rgb(1, 1, 1) && stretch.medium.sees_lights;
  if (!scene.lamps().empty() && length_ > 0 && is_seen_straight)
    lamps_.emplace(scene.lamps(), segment.ray, begin_, begin_ + length_);
}

Interaction ScatteringStretch::vertex_at(float t) const {
  Interaction at{{}, segment_.media, segment_.media, {}};
  at.position = segment_.ray.at(t);
  at.error = at.ng = Vec3f(0, 0, 0);
  at.t = t;
  at.time = segment_.ray.time;
  at.instance = at.primitive = TriangleId::none;
  return at;
}

Rgb ScatteringStretch::sample(double u, std::optional<Interaction>& hit) {
  const FreeFlight::Sample flown = flight_.sample(u);
  if (flown.is_scattered) {
    t_ = begin_ + std::min(flown.distance, length_);
    hit = vertex_at(t_);
  }
  return flown.weight;
}

std::optional<ScatteringStretch::LitVertex> ScatteringStretch::sample_lit(float u, float v) const {
  if (!lamps_) return std::nullopt;
  const auto place = lamps_->sample(u, v);
  if (!place) return std::nullopt;
  const Interaction at = vertex_at(place->t);
  auto light = scene_.light_from(place->light, at);
  if (!light) return std::nullopt;
  const float distance = place->t - begin_;
  const float other_pdf = flight_.pdf(distance) * scene_.light_prob(at, place->light);
  const Rgb weight = flight_.scattered(distance) * (power_heuristic(place->pdf, other_pdf) / place->pdf);
  return LitVertex{at, weight, *light};
}

float ScatteringStretch::weight(const LightSample& light) const {
  if (!lamps_ || light.source.kind != LightSource::Kind::lamp) return 1;
  return power_heuristic(flight_.pdf(t_ - begin_) * light.choice_prob, lamps_->pdf(light.light, t_));
}

}  // namespace vernier
