// SPDX-License-Identifier: Apache-2.0
#include "vernier/ground.h"

#include "scene/geometry.h"
#include "scene/subject.h"

namespace vernier {

void add_ground(SceneDescription& description, GroundKind kind) {
  constexpr float reach = 100, gap = 1e-4f;  // in radii of the subject; the gap keeps flat bottoms above it
  const SceneGeometry geometry(description.meshes, description.instances);
  const Subject subject(geometry);
  if (subject.empty()) return;
  const Bounds& bounds = subject.bounds();
  const Vec3f below(bounds.center().x, bounds.lower.y - gap * bounds.radius(), bounds.center().z);
  const float side = reach * bounds.radius();

  MeshDescription square;
  square.name = "ground";
  square.positions = {below + Vec3f(-side, 0, -side), below + Vec3f(-side, 0, side),
                      below + Vec3f(side, 0, side), below + Vec3f(side, 0, -side)};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  MaterialDescription matt;
  matt.name = "ground";
  matt.base_color = {0.5f, 0.5f, 0.5f, 1};
  matt.metallic = matt.specular = 0;
  matt.catches_shadow = kind == GroundKind::shadow;
  description.instances.push_back(
      {"ground", uint32_t(description.meshes.size()), uint32_t(description.materials.size()), {}});
  description.meshes.push_back(std::move(square));
  description.materials.push_back(std::move(matt));
  description.choices.emplace_back("ground", kind == GroundKind::shadow ? "shadow" : "matte");
}

}  // namespace vernier
