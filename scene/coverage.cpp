// SPDX-License-Identifier: Apache-2.0
#include "scene/coverage.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>

#include "core/sampling/sampler.h"
#include "materials/texture_pixels.h"
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

/// Of all texels; filtering gives no less.
template <typename T>
float least_alpha(const BasicImage<T>& image) {
  if (image.channels % 2 != 0) return 1;
  const auto channels = size_t(image.channels);
  constexpr T most = std::numeric_limits<T>::max();
  T least = most;
  for (size_t i = channels - 1; i < image.values.size() && least > 0; i += channels)
    least = std::min(least, image.values[i]);
  return float(least) / float(most);
}

}  // namespace

std::vector<bool> cut_instances(const SceneGeometry& geometry, std::span<const MaterialDescription> materials,
                                std::span<const Texture> textures) {
  std::map<int, float> of_textures;
  std::vector<float> of_materials(materials.size());
  for (size_t i = 0; i < materials.size(); ++i) {
    of_materials[i] = materials[i].base_color.w;
    if (const TextureUse& use = materials[i].base_color_texture;
        use && materials[i].alpha_mode != AlphaMode::opaque) {
      const auto [entry, is_new] = of_textures.try_emplace(use.texture);
      if (is_new)
        entry->second = std::visit([](const auto& image) { return least_alpha(*image); },
                                   in_memory(textures[size_t(use.texture)].pixels()));
      of_materials[i] *= entry->second;
    }
  }
  std::vector<bool> cut(geometry.instance_count());
  for (uint32_t i = 0; i < cut.size(); ++i) {
    const MaterialDescription& material = materials[geometry.material_of(i)];
    if (material.alpha_mode == AlphaMode::opaque) continue;
    const float needed = material.alpha_mode == AlphaMode::mask ? material.alpha_cutoff : 1;
    cut[i] = of_materials[geometry.material_of(i)] * geometry.least_alpha(i) < needed;
  }
  return cut;
}

bool CoverageFilter::accept(const Ray& ray, const RawHit& hit) const {
  const Material& material = materials_[material_of_instance_[hit.instance]];
  const float coverage = vernier::coverage(
      geometry_, material, geometry_.surface_point(hit.instance, hit.primitive, {hit.u, hit.v}));
  if (coverage >= 1) return true;
  return coverage > 0 && hash_to_unit(ray, hit) < coverage;
}

}  // namespace vernier
