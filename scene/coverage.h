// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scene/accel/accelerator.h"
#include "scene/geometry.h"

namespace vernier {

/// By instance: whether alpha takes anything from its surface. Programs write BLEND and MASK where nothing is
/// to be cut out; such a material is as good as OPAQUE. `materials` are those of the description that
/// `geometry` was made from.
std::vector<bool> cut_instances(const SceneGeometry& geometry, std::span<const MaterialDescription> materials,
                                std::span<const Texture> textures);

/// Alpha as coverage: lets a hit count with the probability that the material covers the point (glTF
/// alphaMode MASK and BLEND). The choice is a hash of ray and hit, so the same ray meets the same surfaces in
/// every accelerator, and the mean over rays is the coverage.
class CoverageFilter : public HitFilter {
 public:
  CoverageFilter(const SceneGeometry& geometry, std::span<const Material> materials,
                 std::span<const uint32_t> material_of_instance)
      : geometry_(geometry), materials_(materials), material_of_instance_(material_of_instance) {}

  bool accept(const Ray& ray, const RawHit& hit) const override;

 private:
  const SceneGeometry& geometry_;
  std::span<const Material> materials_;
  std::span<const uint32_t> material_of_instance_;
};

}  // namespace vernier
