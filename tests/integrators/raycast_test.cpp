// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

Rgb show(const Scene& scene, const std::string& what, const Ray& ray) {
  IntegratorOptions options;
  options.show = what;
  Sampler sampler(0, 0, 0);
  return make_integrator("raycast", options)->estimate(scene, ray, sampler, {}).radiance;
}

void expect_near(const Rgb& actual, const Rgb& expected, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance);
}

/// The textbook's triangle A(1,1), B(3,4), C(5,2), red, green and blue at the corners, in the plane z = 0.
Scene textbook_triangle() {
  MeshDescription mesh;
  mesh.positions = {{1, 1, 0}, {3, 4, 0}, {5, 2, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
  return SceneBuilder().add(mesh, diffuse(1)).build();
}

// P = (2,2) = 0.6 A + 0.3 B + 0.1 C. The triangle runs clockwise seen from +z, so z = -4 sees its front.
TEST(Raycast, TextbookBarycentrics) {
  const Scene scene = textbook_triangle();
  for (const float z : {-4.f, 4.f}) {
    const Ray ray = ray_through({2, 2, z}, {2, 2, 0});
    expect_near(show(scene, "barycentric", ray), {0.6f, 0.3f, 0.1f}, 1e-6f);
    expect_near(show(scene, "albedo", ray), {0.6f, 0.3f, 0.1f}, 1e-6f);
    expect_near(show(scene, "depth", ray), {4, 4, 4}, 1e-6f);
    expect_near(show(scene, "facing", ray), z < 0 ? Rgb(0, 1, 0) : Rgb(1, 0, 0), 1e-6f);
    expect_near(show(scene, "normal", ray), {0.5f, 0.5f, z < 0 ? 0.f : 1.f}, 1e-6f);
  }
  expect_near(show(scene, "barycentric", ray_through({4, 4, 5}, {4, 4, 0})), {0, 0, 0}, 0);
}

TEST(Raycast, EveryNameShowsSomething) {
  const Scene scene = textbook_triangle();
  for (const std::string_view name : raycast_outputs())
    EXPECT_FALSE(is_black(show(scene, std::string(name), ray_through({2, 2, -4}, {2, 2, 0})))) << name;
}

}  // namespace
}  // namespace vernier::test
