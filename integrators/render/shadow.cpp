// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/shadow.h"

#include <algorithm>

namespace vernier {
namespace {

constexpr uint32_t light_samples = 4;
/// Of the sampler, beyond all that a path reaches.
constexpr uint32_t first_block = 1u << 20;

}  // namespace

void ShadowSums::add(const Scene& scene, const Interaction& at, const Vec3f& wo, Sampler sampler) {
  const Vec3f front = scene.geometry().shading_normal(at);
  const Vec3f normal = dot(at.ng, wo) < 0 ? -front : front;
  for (uint32_t i = 0; i < light_samples; ++i) {
    sampler.start_block(first_block + i);
    const Vec2d place = sampler.next2_fine();
    const auto light = scene.sample_light(at, sampler.next1_fine(), place);
    if (!light || !(light->pdf > 0)) continue;
    const Rgb irradiance = light->radiance * (std::max(0.0f, dot(normal, light->wi)) / light->pdf);
    if (is_black(irradiance)) continue;
    unhindered += irradiance;
    const Passage passage = transmittance(scene, at.spawn_to(*light));
    if (!passage.is_bent) arriving += irradiance * passage.fraction;
  }
}

Rgb ShadowSums::lit() const {
  Rgb lit(1, 1, 1);
  for (int c = 0; c < 3; ++c)
    if (unhindered[c] > 0) lit[c] = std::min(arriving[c] / unhindered[c], 1.0f);
  return lit;
}

}  // namespace vernier
