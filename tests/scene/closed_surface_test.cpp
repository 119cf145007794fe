// SPDX-License-Identifier: Apache-2.0
#include "scene/closed_surface.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

ClosedSurfaceTest tested(const MeshDescription& mesh) {
  Bounds box;
  for (const Vec3f& p : mesh.positions) box.add(p);
  ClosedSurfaceTest test(box.lower, box.upper);
  for (const Triangle& t : mesh.triangles)
    test.add(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
  return test;
}

MeshDescription without(MeshDescription mesh, size_t first, size_t count) {
  const auto begin = mesh.triangles.begin() + ptrdiff_t(first);
  mesh.triangles.erase(begin, begin + ptrdiff_t(count));
  return mesh;
}

TEST(ClosedSurface, Bodies) {
  for (const bool inward : {false, true}) {
    const auto test = tested(box({100, -2, 3}, {101, 5, 3.001f}, inward));
    EXPECT_TRUE(test.is_closed());
    EXPECT_EQ(test.is_inward(), inward);
  }
  EXPECT_TRUE(tested(sphere({-7, 1e3f, 2}, 0.3f, 12, 24)).is_closed());
  EXPECT_FALSE(tested(sphere({-7, 1e3f, 2}, 0.3f, 12, 24)).is_inward());
}

// A box of any shape and place without one or two of its six faces is open: opposite ones too, whose fluxes
// through the holes cancel in all but uneven fields.
TEST(ClosedSurface, BoxesWithoutFaces) {
  Random random(3);
  for (int k = 0; k < 50; ++k) {
    const Vec3f at(random.next1() * 20, random.next1(), -random.next1() * 3);
    const MeshDescription whole =
        box(at, at + Vec3f(0.1f + random.next1(), 0.1f + random.next1(), 0.1f + random.next1()));
    ASSERT_TRUE(tested(whole).is_closed());
    for (size_t a = 0; a < 6; ++a) {
      const MeshDescription one = without(whole, 2 * a, 2);
      EXPECT_FALSE(tested(one).is_closed());
      for (size_t b = 0; b < 5; ++b) EXPECT_FALSE(tested(without(one, 2 * b, 2)).is_closed());
    }
  }
}

TEST(ClosedSurface, Sheets) {
  EXPECT_FALSE(tested(parallelogram({0, 0, 0}, {1, 0, 0}, {0, 0, 1})).is_closed());
  EXPECT_FALSE(tested(disk_facing_down(2, 1, 30)).is_closed());
  EXPECT_FALSE(tested(MeshDescription{}).is_closed());
  const MeshDescription ball = sphere({0, 0, 0}, 1, 20, 40);
  EXPECT_FALSE(tested(without(ball, 0, ball.triangles.size() / 2)).is_closed());
  EXPECT_FALSE(tested(without(ball, 0, 40)).is_closed()) << "a hole of half a percent";
}

// Halves whose vertices along the seam differ fit all the same, and a pinhole is none.
TEST(ClosedSurface, SeamsAndPinholes) {
  MeshDescription mesh = without(box({0, 0, 0}, {1, 1, 1}), 0, 2);
  for (int i = 0; i < 7; ++i) {
    const float z0 = float(i) / 7, z1 = float(i + 1) / 7;
    const auto n = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{0, 0, z0}, {0, 0, z1}, {0, 1, z1}, {0, 1, z0}});
    mesh.triangles.push_back({n, n + 1, n + 2});
    mesh.triangles.push_back({n, n + 2, n + 3});
  }
  EXPECT_TRUE(tested(mesh).is_closed());
  const MeshDescription ball = sphere({0, 0, 0}, 1, 100, 200);
  EXPECT_TRUE(tested(without(ball, 5000, 2)).is_closed());
}

}  // namespace
}  // namespace vernier::test
