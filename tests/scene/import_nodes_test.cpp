// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

void expect_near(const Vec3f& actual, const Vec3f& expected, float tolerance = 1e-6f) {
  EXPECT_NEAR(length(actual - expected), 0, tolerance) << actual << " is not " << expected;
}

/// A file whose mesh 0 is the triangle, with no node yet.
GltfFile mesh_only() {
  GltfFile file;
  file.add_triangle();
  file.json.erase("nodes");
  file.json.erase("scenes");
  return file;
}

TEST(ImportNodes, ComposesTranslationRotationScale) {
  GltfFile file = mesh_only();
  const double half = std::sqrt(0.5);
  // Scaled by (2,3,4), turned a quarter about +z, moved by (10,20,30).
  file.add_root(
      {{"mesh", 0}, {"translation", {10, 20, 30}}, {"rotation", {0, 0, half, half}}, {"scale", {2, 3, 4}}});
  const Transform transform = file.import().instances.at(0).to_world;
  expect_near(transform.point({1, 0, 0}), {10, 22, 30});
  expect_near(transform.point({0, 1, 0}), {7, 20, 30});
  expect_near(transform.point({0, 0, 1}), {10, 20, 34});
}

TEST(ImportNodes, ReadsMatricesByColumns) {
  GltfFile file = mesh_only();
  file.add_root({{"mesh", 0}, {"matrix", {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1}}});
  const Transform transform = file.import().instances.at(0).to_world;
  EXPECT_EQ(transform.x, Vec3f(1, 2, 3));
  EXPECT_EQ(transform.y, Vec3f(4, 5, 6));
  EXPECT_EQ(transform.origin, Vec3f(11, 12, 13));
}

TEST(ImportNodes, MultipliesDownTheHierarchy) {
  GltfFile file = mesh_only();
  const int leaf = file.add("nodes", {{"mesh", 0}, {"translation", {1, 0, 0}}, {"name", "leaf"}});
  const int middle = file.add("nodes", {{"scale", {2, 2, -2}}, {"children", {leaf}}});
  file.add_root({{"translation", {0, 5, 0}}, {"children", {middle}}});
  const SceneDescription scene = file.import();
  expect_near(scene.instances.at(0).to_world.point({1, 0, 1}), {4, 5, -2});
  EXPECT_LT(scene.instances.at(0).to_world.determinant(), 0);
  EXPECT_EQ(scene.instances.at(0).name, "leaf");
}

TEST(ImportNodes, AccumulatesInDoublePrecision) {
  GltfFile file = mesh_only();
  const int leaf = file.add("nodes", {{"mesh", 0}, {"translation", {-1e9, 0, 0}}});
  file.add_root({{"translation", {1e9 + 0.25, 0, 0}}, {"children", {leaf}}});
  EXPECT_EQ(file.import().instances.at(0).to_world.origin, Vec3f(0.25f, 0, 0));
}

TEST(ImportNodes, StoresAMeshOnceForManyNodes) {
  GltfFile file = mesh_only();
  for (int i = 0; i < 5; ++i) file.add_root({{"mesh", 0}, {"translation", {i, 0, 0}}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.instances[3].to_world.origin, Vec3f(3, 0, 0));
}

TEST(ImportNodes, NormalisesRotations) {
  GltfFile file = mesh_only();
  file.add_root({{"mesh", 0}, {"rotation", {0, 0, 5, 5}}});
  expect_near(file.import().instances.at(0).to_world.x, {0, 1, 0});
  EXPECT_TRUE(has_notice(file.import(), "1 rotations were not of unit length"));
}

TEST(ImportNodes, ShowsTheDefaultSceneOnly) {
  GltfFile file = mesh_only();
  for (int i = 0; i < 3; ++i) file.add("nodes", {{"mesh", 0}, {"name", std::string(1, char('a' + i))}});
  EXPECT_EQ(file.import().instances.size(), 3u) << "no scene: all roots";
  file.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {2}}}};
  EXPECT_EQ(file.import().instances.at(0).name, "a");
  file.json["scene"] = 1;
  EXPECT_EQ(file.import().instances.at(0).name, "c");
}

TEST(ImportNodes, RejectsWhatIsNoTree) {
  GltfFile file = mesh_only();
  file.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  EXPECT_THAT(import_error(file), HasSubstr("/nodes/0: the node is its own ancestor"));
  file.json["nodes"] = {{{"children", {0}}}};
  EXPECT_THAT(import_error(file), HasSubstr("own ancestor"));
  file.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, json::object()};
  EXPECT_THAT(import_error(file), HasSubstr("/nodes/1/children/0: node 2 has two parents, 0 and 1"));
  file.json["nodes"] = {{{"children", {1, 1}}}, json::object()};
  EXPECT_THAT(import_error(file), HasSubstr("two parents"));
  file.json["nodes"] = {{{"children", {1}}}, json::object()};
  file.json["scenes"] = {{{"nodes", {1}}}};
  EXPECT_THAT(import_error(file), HasSubstr("/scenes/0/nodes/0: node 1 is a child of node 0"));
  file.json["scenes"] = {{{"nodes", {0, 0}}}};
  EXPECT_THAT(import_error(file), HasSubstr("listed twice"));
}

/// They are read 4096 at a time.
TEST(ImportNodes, ReadsManyInTheirOrder) {
  constexpr size_t count = 9000;
  GltfFile file = mesh_only();
  for (size_t i = 0; i < count; ++i)
    file.add_root({{"mesh", 0}, {"name", std::to_string(i)}, {"translation", {i, 0, 0}}});
  file.json["nodes"][0]["children"] = {file.add("nodes", {{"mesh", 0}, {"translation", {0, 1, 0}}})};
  const SceneDescription scene = file.import();
  ASSERT_EQ(scene.instances.size(), count + 1);
  EXPECT_EQ(scene.instances[1].to_world.origin, Vec3f(0, 1, 0));
  for (size_t i = 1; i < count; ++i) {
    EXPECT_EQ(scene.instances[i + 1].name, std::to_string(i));
    EXPECT_EQ(scene.instances[i + 1].to_world.origin, Vec3f(float(i), 0, 0));
  }
}

TEST(ImportNodes, SurvivesLongChains) {
  GltfFile file = mesh_only();
  constexpr int length = 100000;
  json nodes = json::array();
  for (int i = 0; i < length; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {1, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  file.json["nodes"] = std::move(nodes);
  EXPECT_EQ(file.import().instances.at(0).to_world.origin, Vec3f(length, 0, 0));
}

TEST(ImportNodes, LeavesOutTransformsThatDoNotFit) {
  GltfFile file = mesh_only();
  const int leaf = file.add("nodes", {{"mesh", 0}, {"scale", {1e30, 1, 1}}});
  file.add_root({{"children", {leaf}}, {"scale", {1e30, 1, 1}}});
  EXPECT_TRUE(has_notice(file.import(), "the mesh of node '' reaches farther than"));
  file.json["nodes"][0]["scale"] = {1e200, 1, 1};
  EXPECT_TRUE(file.import().instances.empty());
  file.json["nodes"][0] = {{"mesh", 0}, {"matrix", {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
  EXPECT_THAT(import_error(file), HasSubstr("/nodes/0: the transform is not affine"));
}

TEST(ImportNodes, LeavesOutWhatIsTooFarOut) {
  for (const float size : {1e17f, 2e18f, 1e25f, 3.4e38f}) {
    GltfFile file;
    const int positions = file.add_accessor(std::vector<float>{0, 0, 0, size, 0, 0, 0, -size, 0}, "VEC3");
    file.add_mesh({{"POSITION", positions}});
    const SceneDescription scene = file.import();
    EXPECT_EQ(has_notice(scene, "reaches farther than 1e+18 m"), size > 1e18f) << size;
    EXPECT_EQ(scene.instances.empty(), size > 1e18f) << size;
  }
  GltfFile file = mesh_only();
  file.add_root({{"mesh", 0}, {"name", "star"}, {"translation", {0, 0, -3.4e38}}});
  const SceneDescription scene = file.import();
  EXPECT_TRUE(has_notice(scene, "the mesh of node 'star' reaches farther than"));
  EXPECT_TRUE(scene.instances.empty());
}

TEST(ImportNodes, PlacesGpuInstances) {
  GltfFile file = mesh_only();
  const int translations = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0}, "VEC3");
  const int rotations = file.add_accessor(std::vector<int8_t>{0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", true);
  const json attributes = {{"TRANSLATION", translations}, {"ROTATION", rotations}};
  file.add_root({{"mesh", 0},
                 {"scale", {2, 2, 2}},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.meshes.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 2u);
  expect_near(scene.instances[0].to_world.point({1, 0, 0}), {4, 0, 0});
  // Half a turn about z, then up by one, then doubled.
  expect_near(scene.instances[1].to_world.point({1, 0, 0}), {-2, 2, 0});

  file.json["accessors"][size_t(rotations)]["count"] = 1;
  EXPECT_THAT(import_error(file),
              HasSubstr("/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION"));
}

TEST(ImportNodes, HidesInvisibleNodesAndTheirChildren) {
  GltfFile file = mesh_only();
  const int child = file.add("nodes", {{"mesh", 0}});
  file.add_root(
      {{"mesh", 0}, {"children", {child}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
  EXPECT_TRUE(file.import().instances.empty());
  file.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(file.import().instances.size(), 2u);
}

TEST(ImportNodes, ReadsCameras) {
  GltfFile file = mesh_only();
  file.add("cameras", {{"type", "perspective"},
                       {"name", "eye"},
                       {"perspective", {{"yfov", 0.5}, {"aspectRatio", 2}, {"znear", 0.1}}}});
  file.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 4}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
  file.add_root({{"camera", 0}, {"translation", {0, 0, 7}}});
  file.add_root({{"camera", 1}, {"name", "plan"}});
  const SceneDescription scene = file.import();
  ASSERT_EQ(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].kind, CameraDescription::Kind::perspective);
  EXPECT_EQ(scene.cameras[0].name, "eye");
  EXPECT_EQ(scene.cameras[0].yfov, 0.5f);
  EXPECT_EQ(scene.cameras[0].aspect, 2.f);
  EXPECT_EQ(scene.cameras[0].to_world.origin, Vec3f(0, 0, 7));
  EXPECT_EQ(scene.cameras[1].kind, CameraDescription::Kind::orthographic);
  EXPECT_EQ(scene.cameras[1].name, "plan");
  EXPECT_EQ(scene.cameras[1].xmag, 4.f);
  EXPECT_EQ(scene.cameras[1].ymag, 2.f);
}

TEST(ImportNodes, ReadsPunctualLights) {
  GltfFile file = mesh_only();
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"intensity", 3}, {"color", {1, 0.5, 0}}},
      {{"type", "point"}, {"range", 12}, {"name", "bulb"}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  for (int i = 0; i < 3; ++i)
    file.add_root({{"translation", {i, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  const SceneDescription scene = file.import();
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, PunctualLightDescription::Kind::directional);
  EXPECT_EQ(scene.lights[0].intensity, 3.f);
  EXPECT_EQ(scene.lights[0].color, Rgb(1, 0.5f, 0));
  EXPECT_EQ(scene.lights[1].kind, PunctualLightDescription::Kind::point);
  EXPECT_EQ(scene.lights[1].range, 12.f);
  EXPECT_EQ(scene.lights[1].name, "bulb");
  EXPECT_EQ(scene.lights[2].kind, PunctualLightDescription::Kind::spot);
  EXPECT_EQ(scene.lights[2].inner_cone, 0.1f);
  EXPECT_EQ(scene.lights[2].outer_cone, 0.2f);
  EXPECT_TRUE(std::isinf(scene.lights[2].range));
  EXPECT_EQ(scene.lights[2].to_world.origin, Vec3f(2, 0, 0));
}

}  // namespace
}  // namespace vernier::test
