// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/triangle_lights.h"

#include <iterator>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// Lights whose shapes are kept ready: where they take 6 MB at most, beside what a light takes anyhow.
constexpr size_t most_ready = 1 << 16;

/// The lights that the triangles of one instance are, and by triangle the index of its own among them, -1 for
/// none.
std::vector<TriangleLight> lights_of(EmissiveMesh& mesh, size_t triangles,
                                     std::vector<int32_t>& of_triangle) {
  std::vector<TriangleLight> lights(triangles);
  parallel_for(triangles, [&](size_t i) { lights[i] = TriangleLight(mesh, uint32_t(i)); });
  // The halves of a quad follow each other in what programs write.
  std::vector<std::optional<TriangleLight::Joint>> joints(triangles);
  const auto shines = [&](size_t i) { return i < triangles && lights[i].power({}) > 0; };
  parallel_for(triangles, [&](size_t i) {
    if (shines(i) && shines(i + 1)) joints[i] = lights[i].joint(lights[i + 1]);
  });
  of_triangle.assign(triangles, -1);
  size_t count = 0;
  for (size_t i = 0; i < triangles; ++i) {
    if (!shines(i)) continue;
    TriangleLight light = lights[i];
    of_triangle[i] = int32_t(count);
    if (joints[i]) {
      light.take_in(lights[i + 1], *joints[i]);
      of_triangle[++i] = int32_t(count);
    }
    lights[count++] = light;
  }
  lights.resize(count);
  return lights;
}

}  // namespace

TriangleLights collect_triangle_lights(const SceneGeometry& geometry, std::span<const Material> materials,
                                       std::span<const uint32_t> material_of_instance) {
  const size_t instances = geometry.instance_count();
  TriangleLights all;
  all.of_triangle.resize(instances);
  std::vector<std::unique_ptr<EmissiveMesh>> meshes(instances);
  std::vector<std::vector<TriangleLight>> lights(instances);
  parallel_for(instances, [&](size_t i) {
    const Material& material = materials[material_of_instance[i]];
    if (!material.is_emissive() || material.is_unlit()) return;
    meshes[i] = std::make_unique<EmissiveMesh>(geometry, material, uint32_t(i));
    lights[i] = lights_of(*meshes[i], geometry.triangle_count(uint32_t(i)), all.of_triangle[i]);
  });
  size_t count = 0;
  for (const auto& own : lights) count += own.size();
  all.lights.reserve(count);
  for (size_t i = 0; i < instances; ++i) {
    if (!meshes[i]) continue;
    const auto first = int32_t(all.lights.size());
    for (int32_t& light : all.of_triangle[i])
      if (light >= 0) light += first;
    all.lights.insert(all.lights.end(), lights[i].begin(), lights[i].end());
    lights[i] = {};
    meshes[i]->settle(std::span(all.lights).subspan(size_t(first)), count <= most_ready);
    all.meshes.push_back(std::move(meshes[i]));
  }
  return all;
}

}  // namespace vernier
