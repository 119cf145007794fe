// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/material.h"
#include "scene/geometry.h"

namespace vernier {

/// Radiance that a surface emits at `point` toward the unit direction wo, which leaves from the side given.
inline Rgb emission(const SceneGeometry& geometry, const Material& material, const SurfacePoint& point,
                    bool front, const Vec3f& wo) {
  const SurfaceAttributes attributes =
      material.needs_attributes() ? geometry.attributes(point, wo) : SurfaceAttributes{};
  const float cosine = material.has_coat() ? dot(geometry.shading_normal(point), wo) : 1;
  return material.emission(attributes, front, cosine);
}

/// Part of light that meets the surface at `point` at all (glTF alphaMode).
inline float coverage(const SceneGeometry& geometry, const Material& material, const SurfacePoint& point) {
  return material.coverage(material.needs_attributes() ? geometry.attributes(point) : SurfaceAttributes{});
}

}  // namespace vernier
