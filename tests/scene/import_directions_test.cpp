// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <numbers>

#include "scene/camera.h"
#include "scene/lights/environment.h"
#include "scene/lights/punctual.h"
#include "tests/scene/import_support.h"

// Cameras and lights that look somewhere, hardly, or nowhere; cones of spot lights.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// A camera, a sun, a spot light and a lamp, all of one node.
SceneDescription on_node(const json& node) {
  GltfFile file;
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"name", "sun"}},
                                                              {{"type", "spot"}, {"spot", json::object()}},
                                                              {{"type", "point"}}};
  json root = node;
  root["name"] = "rig";
  root["camera"] = 0;
  root["children"] = {1, 2, 3};
  file.add_root(root);
  for (int i = 0; i < 3; ++i) file.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  return file.import();
}

json matrix(std::vector<double> columns) {
  columns.insert(columns.end(), {0, 0, 0});
  return {{"matrix",
           {columns[0], columns[1], columns[2], 0, columns[3], columns[4], columns[5], 0, columns[6],
            columns[7], columns[8], 0, 1, 2, 3, 1}}};
}

void expect_orthonormal(const Transform& t) {
  for (const Vec3f& axis : {t.x, t.y, t.z}) EXPECT_NEAR(length(axis), 1, 1e-6);
  EXPECT_NEAR(t.determinant(), 1, 1e-6);
}

TEST(ImportDirections, ScaleAndShearDoNotCount) {
  for (const json& node : {json({{"scale", {2, 3, 4}}}), json({{"scale", {1e-30, 1e-30, 1e-30}}}),
                           json({{"scale", {1e30, 1, 1e-30}}}), json({{"scale", {0, 1, 1}}}),
                           json({{"scale", {1, 0, 1}}}), matrix({1, 0, 0, 0, 1, 7, 0, 0, 1})}) {
    const SceneDescription scene = on_node(node);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].defect, "") << node;
    expect_orthonormal(scene.cameras[0].to_world);
    EXPECT_EQ(scene.cameras[0].to_world.z, Vec3f(0, 0, 1)) << node;
    EXPECT_EQ(scene.cameras[0].to_world.x, Vec3f(1, 0, 0)) << node;
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].to_world.z, Vec3f(0, 0, 1)) << node;
  }
}

TEST(ImportDirections, WithoutADirectionACameraHasADefectAndALightIsLeftOut) {
  for (const json& node :
       {json({{"scale", {0, 0, 0}}}), json({{"scale", {1, 1, 0}}}), matrix({1, 0, 0, 0, 1, 0, 0, 0, 0})}) {
    const SceneDescription scene = on_node(node);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_THAT(scene.cameras[0].defect,
                HasSubstr("/nodes/0: the camera 'rig' of the node 'rig' cannot be used"));
    ASSERT_EQ(scene.lights.size(), 1u) << "a lamp shines to all sides";
    EXPECT_EQ(scene.lights[0].kind, PunctualLightDescription::Kind::point);
    EXPECT_TRUE(has_notice(scene, "the light 'sun' of the node is left out"));
  }
}

TEST(ImportDirections, ACameraNeedsAnUpDirectionToo) {
  for (const json& node : {json({{"scale", {0, 0, 1}}}), matrix({0, 0, 1, 0, 0, 1, 0, 0, 1})}) {
    const SceneDescription scene = on_node(node);
    EXPECT_NE(scene.cameras.at(0).defect, "");
    EXPECT_EQ(scene.lights.size(), 3u);
  }
}

TEST(ImportDirections, WithoutAPlaceNothingShines) {
  GltfFile file;
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  file.add("nodes",
           {{"translation", {1e38, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.add_root({{"scale", {1e38, 1, 1}}, {"children", {0}}});
  EXPECT_TRUE(file.import().lights.empty());
  EXPECT_TRUE(has_notice(file.import(), "the light of the node is left out"));
}

SceneDescription spot(const json& cone) {
  GltfFile file;
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", cone}}};
  file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  return file.import();
}

TEST(ImportDirections, AnInnerConeUpToTheOuterHasASharpEdge) {
  for (const json& cone :
       {json({{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5}}),
        json({{"innerConeAngle", 0.8}, {"outerConeAngle", 0.5}}), json({{"innerConeAngle", 0.8}}),
        json({{"innerConeAngle", 0}, {"outerConeAngle", 0}})}) {
    const SceneDescription scene = spot(cone);
    EXPECT_EQ(scene.lights.at(0).inner_cone, scene.lights.at(0).outer_cone) << cone;
    EXPECT_TRUE(has_notice(scene, "sharp edge")) << cone;
  }
  const SceneDescription close =
      spot({{"innerConeAngle", 0.08968102931976317}, {"outerConeAngle", 0.08968102931976318}});
  EXPECT_EQ(close.lights.at(0).inner_cone, close.lights.at(0).outer_cone);
  EXPECT_TRUE(close.notices.empty()) << "valid, whatever single precision makes of it";
}

TEST(ImportDirections, ASpotLightWithoutAConeHasTheDefaultOne) {
  EXPECT_TRUE(spot(json::object()).notices.empty());
  const SceneDescription scene = spot(nullptr);
  EXPECT_NEAR(scene.lights.at(0).outer_cone, std::numbers::pi / 4, 1e-6);
  EXPECT_EQ(scene.lights.at(0).inner_cone, 0.f);
  EXPECT_TRUE(has_notice(scene, "'spot' is missing; the default cone is used"));
}

TEST(ImportDirections, ConesEndAtARightAngle) {
  const float right_angle = float(std::numbers::pi / 2);
  EXPECT_EQ(spot({{"outerConeAngle", 3}}).lights.at(0).outer_cone, right_angle);
  EXPECT_TRUE(has_notice(spot({{"outerConeAngle", 3}}), "above pi/2 and was clamped"));
  EXPECT_EQ(spot({{"outerConeAngle", 1.5707964}}).lights.at(0).outer_cone, right_angle);
  EXPECT_TRUE(spot({{"outerConeAngle", 1.5707964}}).notices.empty());
  EXPECT_EQ(spot({{"innerConeAngle", 3}, {"outerConeAngle", 3}}).lights.at(0).inner_cone, right_angle);
}

/// Irradiance factor of a spot light of 1 candela a metre away, off its axis by an angle.
float light_at(float inner, float outer, float angle) {
  PunctualLightDescription description;
  description.kind = PunctualLightDescription::Kind::spot;
  description.inner_cone = inner;
  description.outer_cone = outer;
  SurfacePoint point;
  point.position = Vec3f(std::sin(angle), 0, -std::cos(angle));
  point.ng = Vec3f(0, 0, 1);
  const auto sample = PunctualLight(description).sample(point, {0, 0});
  return sample ? sample->radiance.x : 0;
}

TEST(SpotLight, SharpConesAreFullInside) {
  for (const float outer : {0.01f, 0.0897f, 0.5f, 1.5f}) {
    EXPECT_NEAR(light_at(outer, outer, 0), 1, 1e-5) << outer;
    EXPECT_NEAR(light_at(outer, outer, 0.95f * outer), 1, 1e-5) << outer;
    EXPECT_EQ(light_at(outer, outer, 1.05f * outer), 0) << outer;
  }
}

TEST(SpotLight, NarrowConesAreAsBrightAsWideOnes) {
  for (const float outer : {0.02f, 0.2f, 1.f}) {
    EXPECT_NEAR(light_at(outer / 2, outer, 0), 1, 1e-5) << outer;
    EXPECT_NEAR(light_at(outer / 2, outer, outer * 0.45f), 1, 1e-5) << outer;
    const float middle = light_at(outer / 2, outer, outer * 0.75f);
    EXPECT_GT(middle, 0.2f) << outer;
    EXPECT_LT(middle, 0.5f) << outer;
    EXPECT_EQ(light_at(outer / 2, outer, outer * 1.05f), 0) << outer;
  }
}

TEST(EnvironmentLight, ReadsItsPictureWhateverTheDirection) {
  auto picture = std::make_shared<Image>(1500, 750, 3);
  std::fill(picture->values.begin(), picture->values.end(), 2.f);
  auto description = std::make_shared<EnvironmentDescription>();
  description->picture = picture;
  const EnvironmentLight light(description);
  for (const float x : {nan, inf, -inf, 0.f, 1e30f, -1e-40f})
    for (const float y : {nan, inf, -inf, 0.f, 1.f, -1.0000001f})
      for (const float z : {nan, -inf, 0.f, -0.f}) {
        EXPECT_EQ(light.radiance({x, y, z}), Rgb(2, 2, 2)) << x << " " << y << " " << z;
        EXPECT_GE(light.eval({}, {x, y, z}, nullptr).pdf, 0);
      }
}

}  // namespace
}  // namespace vernier::test
