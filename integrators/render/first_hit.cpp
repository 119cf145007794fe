// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/first_hit.h"

#include "scene/segment.h"

namespace vernier {

constexpr uint32_t samples_looked_at = 8;  // of each half

FirstHits::FirstHits(const Scene& scene, const Camera& camera, const RenderSettings& options,
                     const Film& film)
    : scene_(scene), camera_(camera), options_(options), film_(film), camera_samples_(camera, options) {}

FirstHitMean FirstHits::mean(int x, int y) const {
  FirstHitMean sum;
  uint32_t count = 0;
  for (int half = 0; half < Film::halves; ++half)
    for (uint32_t i = 0; i < std::min(samples_looked_at, film_.samples(x, y, half)); ++i) {
      const Ray ray = camera_samples_.get({options_.crop.x + x, options_.crop.y + y, half, i}).ray;
      ++count;
      const auto hit = intersect_from_camera(scene_, camera_segment(scene_, ray));
      if (!hit) continue;
      const Shading shading = shade(scene_, *hit, -ray.direction);
      sum.albedo += shading.albedo();
      sum.normal += shading.normal();
      ++sum.coverage;
    }
  if (count == 0) return sum;
  const float part = 1 / float(count);
  return {sum.albedo * part, sum.normal * part, sum.coverage * part};
}

std::optional<FirstHit> FirstHits::at_center(int x, int y) const {
  const Ray ray = camera_.ray({float(options_.crop.x + x) + 0.5f, float(options_.crop.y + y) + 0.5f});
  const auto hit = intersect_from_camera(scene_, camera_segment(scene_, ray));
  if (!hit) return std::nullopt;
  return FirstHit{camera_.depth(ray, hit->t), hit->position, hit->instance};
}

}  // namespace vernier
