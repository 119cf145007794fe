// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/scale_scenes.h"

#include <algorithm>
#include <cmath>

#include "core/sampling/sampler.h"

namespace vernier::apps {
namespace {

/// In [-1, 1), by a number.
float noise(uint64_t number) { return float(mix_bits(number) >> 8) * 0x1p-23f - 1; }

/// A square of 10 m with hills, of at least two triangles.
MeshDescription hills(size_t triangles) {
  const auto side = std::max<size_t>(1, size_t(std::sqrt(double(triangles) / 2)));
  MeshDescription mesh;
  mesh.name = "hills";
  mesh.positions.reserve((side + 1) * (side + 1));
  mesh.triangles.reserve(2 * side * side);
  for (size_t row = 0; row <= side; ++row)
    for (size_t column = 0; column <= side; ++column) {
      const float x = 10 * float(column) / float(side) - 5, z = 10 * float(row) / float(side) - 5;
      mesh.positions.emplace_back(x, 0.3f * std::sin(1.7f * x) * std::cos(1.3f * z), z);
    }
  for (size_t row = 0; row < side; ++row)
    for (size_t column = 0; column < side; ++column) {
      const auto corner = uint32_t(row * (side + 1) + column), below = uint32_t(corner + side + 1);
      mesh.triangles.push_back({corner, below, corner + 1});
      mesh.triangles.push_back({corner + 1, below, below + 1});
    }
  return mesh;
}

SceneDescription scene_of(MeshDescription mesh) {
  SceneDescription scene;
  scene.meshes.push_back(std::move(mesh));
  scene.materials.emplace_back();
  scene.materials[0].base_color = {0.5f, 0.5f, 0.5f, 1};
  scene.materials[0].metallic = 0;
  return scene;
}

/// About +y.
Transform turned(float angle, const Vec3f& origin) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}, origin};
}

}  // namespace

SceneDescription scene_of_triangles(size_t triangles) {
  SceneDescription scene = scene_of(hills(triangles));
  scene.instances.emplace_back();
  return scene;
}

SceneDescription scene_of_instances(size_t instances) {
  constexpr size_t triangles = 100'000;
  SceneDescription scene = scene_of(hills(triangles));
  const auto side = size_t(std::ceil(std::sqrt(double(instances))));
  for (size_t i = 0; i < instances; ++i) {
    InstanceDescription& instance = scene.instances.emplace_back();
    const size_t column = i % side, row = i / side;
    instance.to_world = turned(3 * noise(i), {12 * float(column), 0, 12 * float(row)});
  }
  return scene;
}

SceneDescription scene_of_lights(size_t lights) {
  SceneDescription scene = scene_of(hills(2));
  scene.instances.emplace_back();
  MeshDescription lamps;
  lamps.name = "lamps";
  const float size = 2 / std::sqrt(float(lights));
  for (size_t i = 0; i < lights; ++i) {
    const Vec3f place(5 * noise(6 * i), 1 + noise(6 * i + 1) / 2, 5 * noise(6 * i + 2));
    const auto first = uint32_t(lamps.positions.size());
    lamps.positions.push_back(place);
    lamps.positions.push_back(place + size * Vec3f(1, 0.2f * noise(6 * i + 3), 0));
    lamps.positions.push_back(place + size * Vec3f(0.2f * noise(6 * i + 4), 0.2f * noise(6 * i + 5), 1));
    lamps.triangles.push_back({first, first + 1, first + 2});
  }
  scene.meshes.push_back(std::move(lamps));
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].emissive = {1, 1, 1};
  InstanceDescription& instance = scene.instances.emplace_back();
  instance.mesh = instance.material = 1;
  return scene;
}

}  // namespace vernier::apps
