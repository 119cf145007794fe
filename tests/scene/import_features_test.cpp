// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using Status = FeatureUse::Status;

const FeatureUse* find(const SceneDescription& scene, const std::string& name) {
  for (const auto& feature : scene.features)
    if (feature.name == name) return &feature;
  return nullptr;
}

TEST(ImportFeatures, RefusesARequiredExtensionByName) {
  GltfFile file;
  file.add_triangle();
  file.json["extensionsUsed"] = {"KHR_texture_transform", "VENDOR_magic"};
  file.json["extensionsRequired"] = {"KHR_texture_transform", "VENDOR_magic"};
  EXPECT_THAT(import_error(file), HasSubstr("/extensionsRequired/1: the file requires VENDOR_magic"));
}

TEST(ImportFeatures, WarnsOfAnExtensionMerelyUsed) {
  GltfFile file;
  file.add_triangle();
  file.json["extensionsUsed"] = {"KHR_texture_transform", "VENDOR_magic"};
  const SceneDescription scene = file.import();
  ASSERT_TRUE(find(scene, "VENDOR_magic"));
  EXPECT_EQ(find(scene, "VENDOR_magic")->status, Status::ignored);
  EXPECT_EQ(find(scene, "KHR_texture_transform")->status, Status::exact);
  EXPECT_TRUE(has_notice(scene, "VENDOR_magic is ignored"));
  ImportOptions strict;
  strict.strict = true;
  EXPECT_THAT(import_error(file, strict), HasSubstr("strict: VENDOR_magic is ignored"));
  file.json["extensionsUsed"] = {"KHR_texture_transform"};
  EXPECT_THAT(import_error(file, strict), IsEmpty());
}

TEST(ImportFeatures, SaysWhyOcclusionIsIgnored) {
  GltfFile file;
  file.add_triangle({{"material", 0}});
  file.add("images", {{"uri", "gone.png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"occlusionTexture", {{"index", 0}}}});
  // The picture is not even looked for.
  const SceneDescription scene = file.import();
  ASSERT_TRUE(find(scene, "material.occlusionTexture"));
  EXPECT_EQ(find(scene, "material.occlusionTexture")->status, Status::ignored);
  ASSERT_EQ(scene.notices.size(), 1u);
  EXPECT_EQ(scene.notices[0].severity, Notice::Severity::info);
  ImportOptions strict;
  strict.strict = true;
  EXPECT_THAT(import_error(file, strict), HasSubstr("strict: material.occlusionTexture is ignored"));
}

/// Every glTF model of Debian's assimp-testmodels, broken ones too.
TEST(ImportFeatures, LoadsOrRefusesEveryTestModel) {
  const std::filesystem::path root = "/usr/share/assimp/models";
  if (!std::filesystem::exists(root)) GTEST_SKIP() << "assimp-testmodels is not installed";
  int loaded = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb") continue;
    const std::string path = entry.path().string();
    try {
      import_scene(path);
      ++loaded;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), testing::StartsWith(path + ": "));
      EXPECT_EQ(e.kind(), ErrorKind::input);
      ++refused;
    }
  }
  EXPECT_GE(loaded, 20);
  EXPECT_GE(refused, 10);
}

}  // namespace
}  // namespace vernier::test
