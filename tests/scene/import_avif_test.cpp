// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "scene/import/features.h"
#include "tests/scene/import_support.h"
#include "tests/support/avif_files.h"
#include "tests/support/png_bytes.h"

// EXT_texture_avif.

namespace vernier::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A textured triangle whose texture is called "bark" and has these bytes by the extension.
GltfFile with_avif(const std::vector<uint8_t>& bytes) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, {{"material", 0}});
  file.json["extensionsUsed"] = {"EXT_texture_avif"};
  file.add("images", {{"mimeType", "image/avif"}, {"bufferView", file.add_view(bytes)}});
  file.add("textures", {{"name", "bark"}, {"extensions", {{"EXT_texture_avif", {{"source", 0}}}}}});
  return file;
}

/// A green texel stands for the image of the extension.
void add_fallback(GltfFile& file) {
  const int view = file.add_view(png_bytes({.samples = {0, 255, 0}}));
  file.json["textures"][0]["source"] = file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
}

TEST(ImportAvif, ComesBeforeTheTexturesOwnImage) {
  GltfFile file = with_avif(avif_fixture("rgba"));
  add_fallback(file);
  const SceneDescription scene = file.import();
  const Image8& image = scene.textures.at(0).image();
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.pixel(2, 3)[0], 34);
  EXPECT_EQ(image.pixel(2, 3)[3], 225);
  EXPECT_EQ(extension_use("EXT_texture_avif").status, FeatureUse::Status::exact);
  for (const Notice& notice : scene.notices)
    EXPECT_EQ(notice.severity, Notice::Severity::info) << notice.text;
}

TEST(ImportAvif, KeepsItsTenBits) {
  const SceneDescription scene = with_avif(avif_fixture("ten_bits")).import();
  EXPECT_EQ(scene.textures.at(0).image<uint16_t>().pixel(1, 0)[0], 4100);  // 64 * 65535 / 1023
}

TEST(ImportAvif, FallsBackOrIsRefusedByName) {
  auto broken = avif_fixture("rgb");
  broken.resize(broken.size() - 40);
  GltfFile file = with_avif(broken);
  add_fallback(file);
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.textures.at(0).image().values, (std::vector<uint8_t>{0, 255, 0}));
  EXPECT_TRUE(has_notice(scene, "the image that EXT_texture_avif gives texture 'bark' cannot be used"));

  GltfFile alone = with_avif(broken);
  alone.json["extensionsRequired"] = {"EXT_texture_avif"};
  EXPECT_THAT(import_error(alone), AllOf(HasSubstr("'bark'"), HasSubstr("truncated"),
                                         HasSubstr("the scene requires EXT_texture_avif")));
}

}  // namespace
}  // namespace vernier::test
