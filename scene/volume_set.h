// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "materials/material.h"
#include "scene/geometry.h"
#include "scene/lights/light_set.h"
#include "scene/medium.h"

namespace vernier {

/// Which instances enclose a volume, alone or together. Found before materials are compiled, since a surface
/// that should enclose one and is open has no inside: it is taken for thin-walled.
struct VolumeBoundaries {
  /// `instances` and `materials` of the description that `geometry` was made from; `is_cut` by instance:
  /// alpha makes holes in its surface.
  VolumeBoundaries(const SceneGeometry& geometry, std::span<const InstanceDescription> instances,
                   std::span<const MaterialDescription> materials, const std::vector<bool>& is_cut);

  struct Boundary {
    std::vector<uint32_t> instances;
    bool is_inward = false;  ///< fronts look to the inside
  };
  std::vector<Boundary> closed;
  // Instances whose material asks for a volume that they do not enclose, in order:
  std::vector<uint32_t> open;  ///< the mesh has holes
  std::vector<uint32_t> cut;   ///< alpha makes holes in it

  bool is_thin(uint32_t instance) const {
    return std::binary_search(open.begin(), open.end(), instance) ||
           std::binary_search(cut.begin(), cut.end(), instance);
  }
};

/// Part of a ray between two of its parameters, all in one medium.
struct Stretch {
  const Medium& medium;
  float begin, end;
};

/// Fraction of light that is left of a ray at its end, whose direction has that length in metres.
inline Rgb transmittance(const Stretch& stretch, float scale = 1) {
  return transmittance(stretch.medium, (stretch.end - stretch.begin) * scale);
}

/// A ball in world space.
struct Ball {
  Vec3f center;
  float radius;
};

/// The regions of a scene that a medium other than air fills (KHR_materials_volume). Numbered by increasing
/// priority: of two volumes that overlap the smaller one is there, as what lies in something else displaces
/// it.
class VolumeSet {
 public:
  VolumeSet() = default;
  VolumeSet(const VolumeBoundaries& boundaries, const SceneGeometry& geometry,
            std::span<const Material> materials, std::span<const uint32_t> material_of_instance);

  /// No surface bounds a volume.
  bool empty() const { return media_.empty(); }
  /// Some medium scatters light.
  bool scatter() const {
    const auto scatters = [](const Medium& medium) { return medium.scatters(); };
    return air_.scatters() || std::any_of(media_.begin(), media_.end(), scatters);
  }
  /// There is nothing anywhere but empty air.
  bool are_clear() const { return empty() && !air_fills_; }
  /// Number of the volume that the instance bounds; MediumStack::air for others.
  uint32_t of_instance(uint32_t instance) const {
    return empty() ? MediumStack::air : of_instance_[instance].volume;
  }
  /// A boundary is met from the outside of its volume.
  bool is_met_from_outside(const SurfacePoint& point) const {
    return point.front != (!empty() && of_instance_[point.instance].is_inward);
  }
  const Medium& medium(const MediumStack& stack) const {
    return stack.empty() ? air_ : media_[stack.current()];
  }
  /// What a ray travels through between two of its parameters, if it lies in `stack` there.
  Stretch stretch(const MediumStack& stack, const Ray& ray, float begin, float end) const {
    if (!stack.empty() || !air_fills_) return {medium(stack), begin, end};
    return in_air(ray, begin, end);
  }

  /// Fills the air with `medium` as far as `ball` reaches, beyond is nothing; a ball of no radius: not at
  /// all. Its index must be that of air.
  void fill_air(const Medium& medium, const Ball& ball) {
    air_ = ball.radius > 0 ? medium : Medium{};
    air_fills_ = ball.radius > 0 ? std::optional(ball) : std::nullopt;
  }
  /// Whether the point may lie in a volume; false: it certainly lies in none.
  bool may_contain(const Vec3f& point) const;
  /// Looks which volumes certainly see no light: those with no light of `lights` inside, and no boundary that
  /// is emissive or, by `clear`, lets light pass straight on, by instance.
  void find_dim_ones(const std::vector<bool>& clear, std::span<const Material> materials,
                     std::span<const uint32_t> material_of_instance, const LightSet& lights);
  /// Some volumes touch, overlap or lie in each other.
  bool are_nested() const { return are_nested_; }

 private:
  struct Side {
    uint32_t volume = MediumStack::air;
    bool is_inward = false;
  };

  Stretch in_air(const Ray& ray, float begin, float end) const;

  Medium air_;
  std::optional<Ball> air_fills_;  ///< none: air is empty
  std::vector<Medium> media_;
  std::vector<Bounds> bounds_;  ///< by volume
  Bounds all_bounds_;
  std::vector<Side> of_instance_;
  bool are_nested_ = false;
};

}  // namespace vernier
