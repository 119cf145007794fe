// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "tests/support/effort.h"

namespace vernier::test {

MaterialDescription diffuse(float reflectance) {
  MaterialDescription m;
  m.base_color = {reflectance, reflectance, reflectance, 1};
  m.metallic = 0;
  m.specular = 0;
  return m;
}

MaterialDescription emitter(float radiance) {
  MaterialDescription m = diffuse(0);
  m.emissive = Rgb(radiance);
  return m;
}

MaterialDescription metal(float roughness) {
  MaterialDescription m;
  m.roughness = roughness;
  return m;
}

MaterialDescription plastic(float roughness) {
  MaterialDescription m = metal(roughness);
  m.metallic = 0;
  return m;
}

MaterialDescription glass(float roughness) {
  MaterialDescription m = plastic(roughness);
  m.transmission = 1;
  m.thickness = 1;
  return m;
}

PunctualLightDescription point_lamp(const Vec3f& at, float intensity) {
  PunctualLightDescription light;
  light.intensity = intensity;
  light.to_world.origin = at;
  return light;
}

PunctualLightDescription sun(const Vec3f& shines, float irradiance) {
  PunctualLightDescription light;
  light.kind = PunctualLightDescription::Kind::directional;
  light.intensity = irradiance;
  light.to_world.z = -normalize(shines);
  return light;
}

MeshDescription parallelogram(const Vec3f& corner, const Vec3f& a, const Vec3f& b) {
  MeshDescription mesh;
  mesh.positions = {corner, corner + a, corner + a + b, corner + b};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.texcoords[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  return mesh;
}

MeshDescription box(const Vec3f& lower, const Vec3f& upper, bool inward) {
  MeshDescription mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(
        {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z});
  constexpr std::array<std::array<uint32_t, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : faces) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  if (inward)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

MeshDescription sphere(const Vec3f& center, float radius, int rings, int segments) {
  MeshDescription mesh;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < segments; ++j) {
      const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / segments;
      const Vec3d w(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(Vec3f(Vec3d(center) + w * double(radius)));
    }
  const auto at = [&](int i, int j) { return uint32_t(i * segments + j % segments); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < segments; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      if (i + 1 < rings) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  return mesh;
}

MeshDescription smooth_sphere(const Vec3f& center, float radius, int rings, int segments) {
  MeshDescription mesh = sphere(center, radius, rings, segments);
  for (const Vec3f& at : mesh.positions) mesh.normals.push_back(normalize(at - center));
  return mesh;
}

MeshDescription disk_facing_down(float y, float radius, int n) {
  MeshDescription mesh;
  for (int j = 0; j < n; ++j) {
    const double phi = 2 * std::numbers::pi * j / n;
    mesh.positions.push_back({float(radius * std::cos(phi)), y, float(radius * std::sin(phi))});
  }
  for (int j = 1; j + 1 < n; ++j) mesh.triangles.push_back({0, uint32_t(j), uint32_t(j) + 1});
  return mesh;
}

SceneBuilder& SceneBuilder::add(MeshDescription mesh, const MaterialDescription& material,
                                const Transform& to_world) {
  const auto index = uint32_t(description_.meshes.size());
  description_.meshes.push_back(std::move(mesh));
  description_.materials.push_back(material);
  description_.instances.push_back({"", index, index, to_world});
  return *this;
}

SceneBuilder& SceneBuilder::add(const PunctualLightDescription& light) {
  description_.lights.push_back(light);
  return *this;
}

SceneBuilder& SceneBuilder::texture(int width, int height, const std::vector<uint8_t>& texels) {
  auto image = std::make_shared<Image8>(width, height, 1);
  image->values = texels;
  description_.textures.emplace_back(std::move(image), WrapMode::clamp_to_edge, WrapMode::clamp_to_edge,
                                     FilterMode::nearest);
  return *this;
}

SceneBuilder& SceneBuilder::alpha_texture(int width, int height, const std::vector<uint8_t>& alphas) {
  auto image = std::make_shared<Image8>(width, height, 4);
  image->values.assign(4 * alphas.size(), 255);
  for (size_t i = 0; i < alphas.size(); ++i) image->values[4 * i + 3] = alphas[i];
  description_.textures.emplace_back(std::move(image), WrapMode::clamp_to_edge, WrapMode::clamp_to_edge,
                                     FilterMode::nearest);
  return *this;
}

SceneBuilder& SceneBuilder::environment(const std::function<float(const Vec3f&)>& radiance, int height) {
  auto picture = std::make_shared<Image>(2 * height, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const float theta = pi * (float(y) + 0.5f) / float(height),
                  phi = pi * ((float(x) + 0.5f) / float(height) - 1);
      const float value =
          radiance({std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)});
      for (int c = 0; c < 3; ++c) picture->pixel(x, y)[c] = value;
    }
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = std::move(picture);
  description_.environment = std::move(environment);
  return *this;
}

Scene SceneBuilder::build(const std::string& accelerator) { return Scene(description_, {accelerator}); }

void add_flame_cards(SceneBuilder& builder, AlphaMode mode) {
  MaterialDescription flame = emitter(4);
  flame.alpha_mode = mode;
  flame.double_sided = true;
  flame.base_color = {0, 0, 0, 0.9f};
  flame.base_color_texture.texture = 0;
  MaterialDescription veil = emitter(2);
  veil.alpha_mode = AlphaMode::blend;
  veil.base_color = {0, 0, 0, 0.25f};
  builder.alpha_texture(4, 4, {0, 255, 90, 0, 200, 255, 255, 30, 140, 255, 255, 160, 20, 120, 130, 0})
      .add(parallelogram({-1, 0.1f, -1}, {2, 0, 0}, {0, 1.5f, 0.3f}), flame)
      .add(parallelogram({-1, 1.8f, -1}, {2, 0, 0}, {0, 0, 1.5f}), veil);
}

std::unique_ptr<Integrator> path(const IntegratorOptions& options) {
  return make_integrator("path", options);
}

Samples measure(const Scene& scene, const Integrator& integrator, const Ray& ray, int samples, int sets,
                uint64_t seed, float spread) {
  std::vector<double> means(size_t(sets), 0);
  parallel_for(means.size(), [&](size_t set) {
    for (int i = 0; i < samples; ++i) {
      Sampler sampler(uint32_t(set), uint32_t(i), seed);
      means[set] += double(integrator.estimate(scene, ray, sampler, {spread}).radiance.x) / samples;
    }
  });
  Samples result;
  for (const double mean : means) result.add(mean);
  return result;
}

Ray ray_through(const Vec3f& from, const Vec3f& to) {
  Ray ray;
  ray.origin = from;
  ray.direction = normalize(to - from);
  return ray;
}

::testing::AssertionResult sees(const Scene& scene, const Integrator& integrator, const Ray& ray,
                                double expected, double resolution) {
  const double bias = coarsening * resolution * std::abs(expected);
  Samples measured;
  for (int samples = 1 << 9; samples <= 1 << 18; samples *= 2) {
    measured = measure(scene, integrator, ray, samples);
    if (detectable_bias(measured.standard_error(), 1e-3) > bias) continue;
    if (std::abs(measured.mean() - expected) <= bias) return ::testing::AssertionSuccess();
    break;
  }
  return ::testing::AssertionFailure() << measured.mean() << " +- " << measured.standard_error()
                                       << ", expected " << expected << " within " << bias;
}

}  // namespace vernier::test
