// SPDX-License-Identifier: Apache-2.0
#include "scene/subject.h"

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

MeshDescription ground(float size) {
  return parallelogram({-size / 2, 0, size / 2}, {size, 0, 0}, {0, 0, -size});
}

MeshDescription cube(const Vec3f& center, float size) {
  return box(center - Vec3f(size / 2), center + Vec3f(size / 2));
}

TEST(Subject, AGroundThatDwarfsTheSubjectIsSetting) {
  SceneBuilder builder;
  builder.add(ground(100), diffuse(0.5f)).add(cube({0, 0.1f, 0}, 0.2f), diffuse(0.5f));
  const Scene scene = builder.build();
  const Subject subject(scene.geometry());
  EXPECT_EQ(subject.left_out(), 1u);
  EXPECT_NEAR(subject.bounds().upper.x, 0.1f, 1e-6);
  EXPECT_NEAR(subject.farthest({1, 0, 0}).x, 0.1f, 1e-6);
}

TEST(Subject, SkyDomeAndGroundAreBothSetting) {
  SceneBuilder builder;
  MeshDescription dome = sphere({0, 0, 0}, 1000, 8, 8);
  for (Triangle& t : dome.triangles) std::swap(t[1], t[2]);
  builder.add(std::move(dome), emitter(1)).add(ground(300), diffuse(0.5f));
  builder.add(cube({0, 0.5f, 0}, 1), diffuse(0.5f)).add(cube({2, 0.5f, 0}, 1), diffuse(0.5f));
  const Scene scene = builder.build();
  EXPECT_EQ(Subject(scene.geometry()).left_out(), 2u);
}

TEST(Subject, ABodyWithSmallPartsAndAFloorOfItsSizeAreSeenWhole) {
  SceneBuilder builder;
  builder.add(cube({0, 1, 0}, 2), diffuse(0.5f)).add(cube({0.1f, 1.7f, 1}, 0.03f), diffuse(0.5f));
  builder.add(ground(6), diffuse(0.5f));
  const Scene scene = builder.build();
  const Subject subject(scene.geometry());
  EXPECT_EQ(subject.left_out(), 0u);
  EXPECT_NEAR(subject.bounds().upper.x, 3, 1e-6);
}

TEST(Subject, WhatIsTooFarAndSmallToBeSeenIsAStray) {
  SceneBuilder builder;
  builder.add(cube({0, 0.5f, 0}, 1), diffuse(0.5f)).add(cube({0.6f, 0.5f, 0}, 0.01f), diffuse(0.5f));
  builder.add(cube({300, 40, -500}, 0.01f), diffuse(0.5f));
  const Scene scene = builder.build();
  const Subject subject(scene.geometry());
  EXPECT_EQ(subject.strays(), 1u);
  EXPECT_EQ(subject.left_out(), 0u);
  EXPECT_NEAR(subject.bounds().upper.x, 0.605f, 1e-6) << "a small part near the body is one of its own";
}

TEST(Subject, NothingIsStrayThatIsSeenOrLeavesTheRestAsItIs) {
  // A house in the distance is seen beside a cube; of a cloud of grains none is more than the others; and
  // without the screw the cubes would be no larger.
  SceneBuilder house, cloud, far_cubes;
  house.add(cube({0, 0, 0}, 1), diffuse(0.5f)).add(cube({200, 0, 0}, 1), diffuse(0.5f));
  far_cubes.add(cube({0, 0, 0}, 1), diffuse(0.5f)).add(cube({100, 0, 0}, 1), diffuse(0.5f));
  far_cubes.add(cube({100, 60, 0}, 0.01f), diffuse(0.5f));
  for (int i = 0; i < 20; ++i) cloud.add(cube({float(i), float(i * i % 7), 0}, 1e-3f), diffuse(0.5f));
  for (SceneBuilder* builder : {&house, &cloud, &far_cubes})
    EXPECT_EQ(Subject(builder->build().geometry()).strays(), 0u);
}

TEST(Subject, WhatIsMadeAPointOfIsNotThere) {
  Transform hidden;
  hidden.x = hidden.y = hidden.z = {0, 0, 0};
  hidden.origin = {7, 0, 0};
  const Scene scene = SceneBuilder()
                          .add(cube({0, 0, 0}, 1), diffuse(0.5f))
                          .add(cube({0, 0, 0}, 1), diffuse(0.5f), hidden)
                          .build();
  EXPECT_NEAR(Subject(scene.geometry()).farthest({1, 0, 0}).x, 0.5f, 1e-6);
}

TEST(Subject, ABodyIsNoSettingToItsSmallestPart) {
  SceneBuilder builder;
  builder.add(sphere({0, 0, 0}, 2, 8, 8), diffuse(0.5f)).add(cube({0, 0, 2}, 0.01f), emitter(1));
  const Scene scene = builder.build();
  EXPECT_EQ(Subject(scene.geometry()).left_out(), 0u);
}

TEST(Subject, AGroundAloneIsTheSubject) {
  const Scene scene = SceneBuilder().add(ground(100), diffuse(0.5f)).build();
  const Subject subject(scene.geometry());
  EXPECT_FALSE(subject.empty());
  EXPECT_EQ(subject.left_out(), 0u);
}

TEST(Subject, InstancesAreFoundWhereTheyStand) {
  Transform moved;
  moved.origin = {10, 0, 0};
  const Scene scene = SceneBuilder().add(cube({0, 0, 0}, 1), diffuse(0.5f), moved).build();
  const Subject subject(scene.geometry());
  EXPECT_NEAR(subject.farthest({1, 0, 0}).x, 10.5f, 1e-5);
  EXPECT_NEAR(subject.farthest({-1, 0, 0}).x, 9.5f, 1e-5);
}

TEST(Subject, NothingIsEmpty) {
  const Scene scene = SceneBuilder().build();
  EXPECT_TRUE(Subject(scene.geometry()).empty());
}

TEST(Subject, ACardFacesTheWayItsFrontDoes) {
  const Vec3f viewer = normalize(Vec3f(0.5f, 0.3f, 1));
  for (const Vec3f& b : {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(0, 0.6f, 0.8f)}) {
    const Scene scene = SceneBuilder().add(parallelogram({3, 2, 1}, {1, 0, 0}, b), diffuse(0.5f)).build();
    const auto normal = Subject(scene.geometry()).flat_normal(viewer);
    ASSERT_TRUE(normal);
    EXPECT_NEAR(length(*normal - cross(Vec3f(1, 0, 0), b)), 0, 1e-5) << b;
  }
}

TEST(Subject, ACardWithTwoFrontsFacesTheViewer) {
  const Scene scene = SceneBuilder().add(box({0, 0, 0}, {2, 1, 0.005f}), diffuse(0.5f)).build();
  const Subject subject(scene.geometry());
  EXPECT_NEAR(subject.flat_normal({0.5f, 0.3f, 1}).value_or(Vec3f(0)).z, 1, 1e-5);
  EXPECT_NEAR(subject.flat_normal({0.5f, 0.3f, -1}).value_or(Vec3f(0)).z, -1, 1e-5);
}

TEST(Subject, AnUprightBoardIsSeenFaceOnAndAThingThatLiesIsNot) {
  const Scene upright = SceneBuilder().add(box({0, 0, 0}, {2, 1, 0.1f}), diffuse(0.5f)).build();
  EXPECT_NEAR(Subject(upright.geometry()).flat_normal({0, 0, 1}).value_or(Vec3f(0)).z, 1, 1e-5);
  const Scene lying = SceneBuilder().add(box({0, 0, 0}, {2, 0.1f, 1}), diffuse(0.5f)).build();
  EXPECT_FALSE(Subject(lying.geometry()).flat_normal({0, 0, 1}));
}

TEST(Subject, BodiesAreNotFlat) {
  const Scene box_scene = SceneBuilder().add(box({0, 0, 0}, {2, 1, 0.2f}), diffuse(0.5f)).build();
  EXPECT_FALSE(Subject(box_scene.geometry()).flat_normal({0, 0, 1}));
  const Scene sphere_scene = SceneBuilder().add(sphere({0, 0, 0}, 1, 16, 32), diffuse(0.5f)).build();
  EXPECT_FALSE(Subject(sphere_scene.geometry()).flat_normal({0, 0, 1}));
}

TEST(Subject, CopiesOfAMeshAreAsFlatAsMeshesOfTheirOwn) {
  // Tiles of a mosaic that hangs on a slope: turned, mirrored and of several sizes, which is a similarity,
  // and one that is stretched, which is not.
  const Vec3f normal = normalize(Vec3f(0.3f, 0.2f, 1)), right = normalize(cross({0, 1, 0}, normal)),
              up = cross(normal, right);
  const auto tile = [&](float size, float stretch, float mirror, const Vec3f& place) {
    return Transform{right * size * stretch * mirror, up * size, normal * size, place};
  };
  const std::vector<Transform> tiles{tile(1, 1, 1, {0, 0, 0}), tile(2, 1, -1, right * 3.f),
                                     tile(0.5f, 1, 1, up * 2.f), tile(1, 1.5f, 1, up * -3.f)};
  const MeshDescription relief = box({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.05f});
  SceneBuilder apart;
  SceneDescription shared;
  shared.meshes = {relief};
  shared.materials = {diffuse(0.5f)};
  for (const Transform& to_world : tiles) {
    apart.add(relief, diffuse(0.5f), to_world);
    shared.instances.emplace_back().to_world = to_world;
  }
  const Scene of_copies(std::move(shared), {}), of_meshes = apart.build();
  const auto found = Subject(of_copies.geometry()).flat_normal({0, 0, 1});
  const auto expected = Subject(of_meshes.geometry()).flat_normal({0, 0, 1});
  ASSERT_TRUE(found && expected);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR((*found)[axis], (*expected)[axis], 1e-5);
  EXPECT_NEAR(dot(*found, normal), 1, 1e-4);
}

}  // namespace
}  // namespace vernier::test
