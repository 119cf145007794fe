// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/first_hit.h"

#include "integrators/render/shadow.h"

namespace vernier {

constexpr uint32_t samples_looked_at = 8;  // of each half

FirstHits::FirstHits(const Scene& scene, const Camera& camera, const RenderSettings& options,
                     const Film& film)
    : scene_(scene),
      camera_(camera),
      options_(options),
      film_(film),
      camera_samples_(camera, scene, options) {}

FirstHits::Met FirstHits::sample(int x, int y, int half, uint32_t i) const {
  const auto [sampler, ray, cone] = camera_samples_.get({options_.crop.x + x, options_.crop.y + y, half, i});
  Met met{ray, sampler, intersect_from_camera(scene_, camera_segment(scene_, ray))};
  if (met.hit) met.hit->footprint = cone.width_at(met.hit->t);
  return met;
}

FirstHitMean FirstHits::mean(int x, int y) const {
  FirstHitMean sum;
  uint32_t count = 0;
  for (int half = 0; half < Film::halves; ++half)
    for (uint32_t i = 0; i < std::min(samples_looked_at, film_.samples(x, y, half)); ++i) {
      ++count;
      const auto [ray, sampler, hit] = sample(x, y, half, i);
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

MetInstances FirstHits::met(int x, int y) const {
  MetInstances met;
  for (int half = 0; half < Film::halves; ++half)
    for (uint32_t i = 0; i < std::min(MetInstances::most_samples / Film::halves, film_.samples(x, y, half));
         ++i) {
      ++met.samples;
      if (const auto hit = sample(x, y, half, i).hit) met.instances[met.count++] = hit->instance;
    }
  return met;
}

Rgb FirstHits::lit(int x, int y) const {
  ShadowSums sums;
  for (int half = 0; half < Film::halves; ++half)
    for (uint32_t i = 0; i < std::min(samples_looked_at, film_.samples(x, y, half)); ++i) {
      const Met met = sample(x, y, half, i);
      if (met.hit) sums.add(scene_, *met.hit, -met.ray.direction, met.sampler);
    }
  return sums.lit();
}

std::optional<FirstHit> FirstHits::at_center(int x, int y) const {
  const Ray ray = camera_.ray({float(options_.crop.x + x) + 0.5f, float(options_.crop.y + y) + 0.5f});
  const auto hit = intersect_from_camera(scene_, camera_segment(scene_, ray));
  if (!hit) return std::nullopt;
  const SceneGeometry& geometry = scene_.geometry();
  return FirstHit{camera_.depth(ray, hit->t),          hit->position,  hit->instance,
                  geometry.material_of(hit->instance), hit->primitive, {hit->u, hit->v},
                  geometry.attributes(*hit).uv[0]};
}

}  // namespace vernier
