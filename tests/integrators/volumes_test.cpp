// SPDX-License-Identifier: Apache-2.0
#include "scene/segment.h"
#include "tests/support/test_scenes.h"

// Volumes in volumes, beside, across and around each other, with the camera outside and inside: what is left
// of light in closed form, on every accelerator.

namespace vernier::test {
namespace {

/// Boundary of a volume of that index that leaves `left` of light after a metre.
MaterialDescription body(float ior, float left = 1) {
  MaterialDescription material = glass(0);
  material.ior = ior;
  material.attenuation_distance = 1;
  material.attenuation_color = Rgb(left);
  return material;
}

MaterialDescription thin(MaterialDescription material) {
  material.thickness = 0;
  return material;
}

SceneBuilder white_sky() {
  SceneBuilder builder;
  return builder.environment([](const Vec3f&) { return 1.f; }, 2);
}

MeshDescription slab(float lower, float upper, float half_width = 4) {
  return box({-half_width, lower, -half_width}, {half_width, upper, half_width});
}

/// Fraction reflected at normal incidence.
double normal_fresnel(double eta) { return std::pow((eta - 1) / (eta + 1), 2); }

// Straight down beside the axis, where boxes have no edges.
const Ray down = ray_through({0.31f, 9, 0.17f}, {0.31f, 0, 0.17f});

/// Radiance along `ray` by path, on each accelerator.
void expect_everywhere(const SceneBuilder& builder, const Ray& ray, double expected,
                       double resolution = 2e-3) {
  IntegratorOptions options;
  options.max_depth = 100;
  options.russian_roulette = false;
  for (const auto& accelerator : accelerators()) {
    const Scene scene = SceneBuilder(builder).build(std::string(accelerator.name));
    EXPECT_TRUE(sees(scene, *path(options), ray, expected, resolution)) << accelerator.name;
  }
}

TEST(Volumes, AirWithinABody) {
  auto scene = white_sky().add(slab(0, 3), body(1, 0.5f)).add(slab(1, 2, 2), body(1));
  expect_everywhere(scene, down, 0.25);
  // In whatever order they come.
  scene = white_sky().add(slab(1, 2, 2), body(1)).add(slab(0, 3), body(1, 0.5f));
  expect_everywhere(scene, down, 0.25);
}

TEST(Volumes, HollowOfTheSameMaterial) {
  MeshDescription shell = slab(0, 3);
  const MeshDescription hollow = box({-2, 1, -2}, {2, 2, 2}, true);
  for (const Triangle& t : hollow.triangles) shell.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  shell.positions.insert(shell.positions.end(), hollow.positions.begin(), hollow.positions.end());
  expect_everywhere(white_sky().add(shell, body(1, 0.5f)), down, 0.25);
}

TEST(Volumes, Overlapping) {
  expect_everywhere(white_sky().add(slab(0, 1), body(1, 0.5f)).add(slab(0.9f, 1.9f), body(1, 0.5f)), down,
                    std::pow(0.5, 1.9));
  // The smaller one displaces the larger.
  expect_everywhere(white_sky().add(slab(0, 1), body(1, 0.5f)).add(slab(0.5f, 2, 2), body(1, 0.25f)), down,
                    std::pow(0.5, 0.5) * std::pow(0.25, 1.5));
  // The same material in one mesh: twice is no more than once.
  MeshDescription both = slab(0, 1);
  const MeshDescription other = slab(0.5f, 1.5f, 2);
  for (const Triangle& t : other.triangles) both.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
  expect_everywhere(white_sky().add(both, body(1, 0.5f)), down, std::pow(0.5, 1.5));
}

TEST(Volumes, Touching) {
  expect_everywhere(white_sky().add(slab(0, 1), body(1, 0.5f)).add(slab(1, 2), body(1, 0.5f)), down, 0.25);
  expect_everywhere(white_sky().add(slab(1, 2), body(1, 0.25f)).add(slab(0, 1), body(1, 0.5f)), down, 0.125);
  // Panes of the same glass in contact are one pane.
  const double f = normal_fresnel(1.5), t = 0.25, one = (1 - f) * (1 - f) * t / (1 - f * f * t * t);
  const double reflected = f + f * t * one;
  expect_everywhere(white_sky().add(slab(0, 1), body(1.5f, 0.5f)).add(slab(1, 2), body(1.5f, 0.5f)), down,
                    one + reflected);
}

TEST(Volumes, TouchingAtOddPlacesAndTurned) {
  const float a = 0.123457f, b = 1.2345678f, c = 2.7182818f;
  Transform turned;
  const float s = std::sin(0.3f), k = std::cos(0.3f);
  turned.x = {k, 0, -s};
  turned.z = {s, 0, k};
  auto scene = white_sky().add(slab(a, b), body(1, 0.5f), turned).add(slab(b, c), body(1, 0.5f), turned);
  expect_everywhere(scene, down, std::pow(0.5, c - a));
}

TEST(Volumes, WindingTheWrongWay) {
  expect_everywhere(white_sky().add(box({-4, 0, -4}, {4, 2, 4}, true), body(1, 0.5f)), down, 0.25);
}

TEST(Volumes, OfSeveralParts) {
  // One box, its floor of another material than the rest; both parts of one object.
  MeshDescription whole = slab(0, 2), floor = whole;
  floor.triangles = {whole.triangles[8], whole.triangles[9]};
  whole.triangles.erase(whole.triangles.begin() + 8, whole.triangles.begin() + 10);
  SceneDescription parts;
  parts.meshes = {whole, floor};
  parts.materials = {body(1, 0.5f), body(1, 0.5f)};
  parts.instances = {{"", 0, 0, {}, 7}, {"", 1, 1, {}, 7}};
  const Scene scene(parts, {});
  EXPECT_TRUE(scene.notices().empty());
  EXPECT_FALSE(scene.volumes().empty());
  EXPECT_EQ(scene.volumes().of_instance(0), scene.volumes().of_instance(1));
  parts.instances[1].object = 8;
  EXPECT_TRUE(Scene(parts, {}).volumes().empty());
}

TEST(Volumes, LiquidInGlass) {
  // Black liquid: what is seen is what the boundaries reflect.
  auto scene = white_sky().add(slab(0, 3), body(1.5f)).add(slab(1, 2, 3), body(1.33f, 0));
  const double outer = normal_fresnel(1.5), inner = normal_fresnel(1.33 / 1.5);
  // Light that goes on bouncing between the two.
  const double expected = outer + (1 - outer) * (1 - outer) * inner / (1 - inner * outer);
  expect_everywhere(scene, down, expected, 1e-2);
}

TEST(Volumes, OpaqueThingsInThem) {
  // Plastic under water reflects what its index differs from that of water.
  MaterialDescription tile = plastic(0);
  tile.base_color = {0, 0, 0, 1};
  auto scene = white_sky().add(slab(-1, 2), body(1.33f)).add(slab(0, 1, 2), tile);
  const double outer = normal_fresnel(1.33), inner = normal_fresnel(1.5 / 1.33);
  expect_everywhere(scene, down, outer + (1 - outer) * (1 - outer) * inner / (1 - inner * outer), 1e-2);
}

TEST(Volumes, ThinWallsInThem) {
  // A clear film in water: no index differs, and the water is there behind it too.
  MaterialDescription film = thin(body(1.33f));
  auto scene = white_sky()
                   .add(slab(-1, 1), body(1, 0.1f))
                   .add(parallelogram({-3, 0.8f, -3}, {0, 0, 6}, {6, 0, 0}), thin(body(1)));
  expect_everywhere(scene, down, 0.01);
  scene = white_sky()
              .add(slab(-1, 1), body(1.33f))
              .add(parallelogram({-3, 0.8f, -3}, {0, 0, 6}, {6, 0, 0}), film);
  expect_everywhere(scene, down, 1);
  // A leaf that lets half of the light through, diffusely, over black ground in a body.
  MaterialDescription leaf = diffuse(1);
  leaf.diffuse_transmission = 0.5f;
  scene = SceneBuilder()
              .environment([](const Vec3f& w) { return w.y > 0 ? 1.f : 0.f; }, 2)
              .add(slab(-1, 1), body(1, 0.1f))
              .add(parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), leaf);
  for (const auto& accelerator : accelerators()) {
    const Scene built = scene.build(std::string(accelerator.name));
    IntegratorOptions options;
    options.max_depth = 100;
    const Samples above = measure(built, *path(options), down, 4096);
    options.light_sampling = LightSampling::bsdf;
    const Samples met = measure(built, *path(options), down, 4096);
    EXPECT_GT(welch_p_value(above, met), 1e-4) << accelerator.name;
    EXPECT_LT(above.mean(), 0.05) << "absorbed twice";
  }
}

TEST(Volumes, CameraInside) {
  const Ray up = ray_through({0.3f, 0.5f, 0.2f}, {0.31f, 3, 0.17f});
  expect_everywhere(white_sky().add(slab(0, 2.5f), body(1, 0.5f)), up,
                    std::pow(0.5, 2 * length(Vec3f(0.01f / 2.5f, 1, 0.03f / 2.5f))));
  // As through a flat port: the sky is no brighter than from the air.
  const double f = normal_fresnel(1.33);
  expect_everywhere(white_sky().add(slab(0, 2.5f), body(1.33f)), up, 1, 3e-3);
  SceneBuilder lit_above;
  lit_above.environment([](const Vec3f& w) { return w.y > 0 ? 1.f : 0.f; }, 2)
      .add(slab(0, 2.5f), body(1.33f));
  expect_everywhere(lit_above, up, (1 - f) / (1 - f * f), 1e-2);
  // In two at once, and in the hollow of one.
  expect_everywhere(white_sky().add(slab(0, 2.5f), body(1, 0.5f)).add(slab(-1, 1.5f, 2), body(1, 0.25f)), up,
                    std::pow(0.25, 1) * std::pow(0.5, 1), 4e-3);
}

TEST(Volumes, OpenOnesAreThinAndSaidToBe) {
  const Scene scene =
      white_sky().add(parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}), body(1.5f, 0.2f)).build();
  ASSERT_EQ(scene.notices().size(), 1u);
  EXPECT_NE(scene.notices()[0].text.find("not closed"), std::string::npos);
  IntegratorOptions options;
  for (const Vec3f& from : {Vec3f(0.3f, 2, 0.2f), Vec3f(0.3f, -2, 0.2f)})
    for (const auto technique : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
      options.light_sampling = technique;
      EXPECT_TRUE(sees(scene, *path(options), ray_through(from, {0.1f, 0, 0.1f}), 1, 1e-3));
    }
}

TEST(Volumes, CutOnesAreThinAndSaidToBe) {
  const auto glass = [](AlphaMode mode, float alpha) {
    MaterialDescription m = body(1, 0.2f);
    m.alpha_mode = mode;
    m.base_color.w = alpha;
    return m;
  };
  for (const auto mode : {AlphaMode::blend, AlphaMode::mask}) {
    const Scene cut = white_sky().add(slab(0, 1), glass(mode, 0.4f)).build();
    ASSERT_EQ(cut.notices().size(), 1u);
    EXPECT_NE(cut.notices()[0].text.find("holes by its alpha"), std::string::npos);
    expect_everywhere(white_sky().add(slab(0, 1), glass(mode, 0.4f)), down, 1);
    // An alpha that takes nothing leaves the volume whole.
    const float enough = mode == AlphaMode::mask ? 0.5f : 1;
    EXPECT_TRUE(white_sky().add(slab(0, 1), glass(mode, enough)).build().notices().empty());
    expect_everywhere(white_sky().add(slab(0, 1), glass(mode, enough)), down, 0.2);
  }
}

TEST(Volumes, ManyOfOneKind) {
  // Nine marbles in a row, instances of one mesh.
  SceneDescription d;
  d.meshes = {sphere({0, 0, 0}, 0.5f, 24, 48)};
  d.materials = {body(1, 0.5f)};
  for (int i = 0; i < 9; ++i) {
    Transform at;
    at.origin = {0, float(i), 0};
    d.instances.push_back({"", 0, 0, at});
  }
  const Scene scene(d, {});
  const Ray ray = ray_through({0.01f, 20, 0.02f}, {0.01f, 0, 0.02f});
  EXPECT_NEAR(transmittance(scene, {ray}).fraction.x, std::pow(0.5, 9), 1e-4);
}

}  // namespace
}  // namespace vernier::test
