// SPDX-License-Identifier: Apache-2.0
#include "core/math/frame.h"

#include <gtest/gtest.h>

#include "core/sampling/warp.h"
#include "tests/support/random.h"

namespace vernier {
namespace {

void expect_orthonormal(const Frame& frame) {
  EXPECT_NEAR(length(frame.x), 1, 2e-6);
  EXPECT_NEAR(length(frame.y), 1, 2e-6);
  EXPECT_NEAR(length(frame.z), 1, 2e-6);
  EXPECT_NEAR(dot(frame.x, frame.y), 0, 2e-6);
  EXPECT_NEAR(dot(frame.y, frame.z), 0, 2e-6);
  EXPECT_NEAR(dot(frame.z, frame.x), 0, 2e-6);
  EXPECT_NEAR(dot(cross(frame.x, frame.y), frame.z), 1, 5e-6) << "right-handed";
}

std::vector<Vec3f> normals() {
  std::vector<Vec3f> list{{0, 0, 1}, {0, 0, -1}, {1, 0, 0},    {-1, 0, 0},
                          {0, 1, 0}, {0, -1, 0}, {1, 0, -0.f}, {0, 1, -0.f}};
  for (const float tiny : {1e-3f, 1e-6f, 1e-12f, 1e-30f})
    for (const float z : {1.f, -1.f}) {
      list.push_back(normalize(Vec3f(tiny, 0, z)));
      list.push_back(normalize(Vec3f(tiny, -tiny, z)));
    }
  test::Random random(1);
  for (int i = 0; i < 20'000; ++i) list.push_back(normalize(sample_sphere(random.next2())));
  return list;
}

TEST(Frame, OrthonormalAboutAnyNormal) {
  for (const Vec3f& n : normals()) {
    SCOPED_TRACE(testing::Message() << n.x << " " << n.y << " " << n.z);
    const Frame frame = Frame::from_normal(n);
    EXPECT_EQ(frame.z, n);
    expect_orthonormal(frame);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Frame, LocalAndWorldAreInverse) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Frame frame = Frame::from_normal(normalize(sample_sphere(random.next2())));
    const Vec3f v = sample_sphere(random.next2()) * 3.f;
    EXPECT_LT(length(frame.to_world(frame.to_local(v)) - v), 1e-5f);
    EXPECT_NEAR(frame.to_local(frame.z).z, 1, 1e-6);
    EXPECT_EQ(frame.to_world({0, 0, 1}), frame.z);
  }
}

TEST(Frame, TangentLiesInItsHalfPlane) {
  test::Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const Vec3f n = normalize(sample_sphere(random.next2())), t = sample_sphere(random.next2()) * 0.01f;
    const float sine = length(cross(n, t)) / length(t);
    const Frame frame = Frame::from_normal_tangent(n, t);
    expect_orthonormal(frame);
    EXPECT_GT(dot(frame.x, t), 0);
    EXPECT_NEAR(dot(frame.y, t) / length(t), 0, 1e-6 / sine);
  }
}

TEST(Frame, TangentNearTheNormalStillGivesRightAngles) {
  test::Random random(4);
  for (const float sine : {1e-2f, 1e-3f, 1e-4f, 1e-5f})
    for (int i = 0; i < 1000; ++i) {
      const Vec3f n = normalize(sample_sphere(random.next2()));
      expect_orthonormal(Frame::from_normal_tangent(n, n + Frame::from_normal(n).x * sine));
    }
}

TEST(Frame, UselessTangentsFallBack) {
  const Vec3f n{0, 0.6f, 0.8f};
  for (const Vec3f& t : {Vec3f(0, 0, 0), n, -n, n * 1e10f, Vec3f(std::nanf(""), 0, 0)}) {
    const Frame frame = Frame::from_normal_tangent(n, t);
    EXPECT_EQ(frame.x, Frame::from_normal(n).x);
    expect_orthonormal(frame);
  }
}

}  // namespace
}  // namespace vernier
