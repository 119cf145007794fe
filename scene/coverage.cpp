// SPDX-License-Identifier: Apache-2.0
#include "scene/coverage.h"

#include <bit>

#include "core/sampling/sampler.h"
#include "scene/emission.h"

namespace vernier {
namespace {

/// Uniform in [0, 1) from the bits of the ray and the triangle; signs of zero do not count.
float hash_to_unit(const Ray& ray, const RawHit& hit) {
  uint64_t h = (uint64_t(hit.instance) << 32) | hit.primitive;
  for (const Vec3f& v : {ray.origin, ray.direction})
    for (int axis = 0; axis < 3; ++axis) {
      h = (h ^ std::bit_cast<uint32_t>(v[axis] + 0.f)) * 0x9e3779b97f4a7c15ull;
      h ^= h >> 29;
    }
  return float(mix_bits(h) >> 8) * 0x1p-24f;
}

}  // namespace

bool CoverageFilter::accept(const Ray& ray, const RawHit& hit) const {
  const Material& material = materials_[material_of_instance_[hit.instance]];
  const float coverage = vernier::coverage(
      geometry_, material, geometry_.surface_point(hit.instance, hit.primitive, {hit.u, hit.v}));
  if (coverage >= 1) return true;
  return coverage > 0 && hash_to_unit(ray, hit) < coverage;
}

}  // namespace vernier
