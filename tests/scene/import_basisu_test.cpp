// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "core/ktx2/ktx2.h"
#include "scene/import/features.h"
#include "tests/scene/import_support.h"
#include "tests/support/ktx2_files.h"
#include "tests/support/png_bytes.h"

// KHR_texture_basisu, and KTX2 files that textures name without it.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string text(const FileBytes& bytes) { return {bytes.begin(), bytes.end()}; }

const json base_color = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
const json basisu_of_image_0 = {{"KHR_texture_basisu", {{"source", 0}}}};

/// A textured triangle whose texture is called "bark" and has the image 0 by the extension.
GltfFile with_basisu(const json& image, const json& material = base_color) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("materials", material);
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, {{"material", 0}});
  file.json["extensionsUsed"] = {"KHR_texture_basisu"};
  file.add("images", image);
  file.add("textures", {{"name", "bark"}, {"extensions", basisu_of_image_0}});
  return file;
}

/// A green texel stands for the image of the extension.
void add_fallback(GltfFile& file) {
  PngSource green;
  green.samples = {0, 255, 0};
  const int view = file.add_view(png_bytes(green));
  file.json["textures"][0]["source"] = file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
}

GltfFile with_embedded(const FileBytes& ktx2, const json& material = base_color) {
  GltfFile file = with_basisu({{"mimeType", "image/ktx2"}}, material);
  file.json["images"][0]["bufferView"] = file.add_view(ktx2);
  return file;
}

std::vector<std::string> warnings(const SceneDescription& scene) {
  std::vector<std::string> texts;
  for (const Notice& notice : scene.notices)
    if (notice.severity == Notice::Severity::warning) texts.push_back(notice.place + ": " + notice.text);
  return texts;
}

void expect_texels(const SceneDescription& scene, const ktx2::Texture& expected) {
  const Image8& image = scene.textures.at(0).image();
  ASSERT_EQ(image.width, int(expected.width));
  ASSERT_EQ(image.height, int(expected.height));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < image.channels; ++c)
        ASSERT_EQ(image.pixel(x, y)[c], expected.rgba[size_t((y * image.width + x) * 4 + c)]);
  EXPECT_THAT(warnings(scene), IsEmpty());
}

TEST(ImportBasisu, ReadsImagesFromEverywhere) {
  const FileBytes file = ktx2_fixture("etc1s_gradient");
  const ktx2::Texture expected = ktx2::decode(file);
  expect_texels(with_embedded(file).import(), expected);

  const TemporaryFolder folder;
  folder.write("a.ktx2", text(file));
  GltfFile external = with_basisu({{"uri", "a.ktx2"}});
  add_fallback(external);
  expect_texels(import_scene(external.save(folder)), expected);

  const std::string uri = fmt::format("data:image/ktx2,%{:02X}", fmt::join(file, "%"));
  expect_texels(with_basisu({{"uri", uri}}).import(), expected);
}

TEST(ImportBasisu, KeepsAlphaThatMeansSomething) {
  const FileBytes with_alpha = ktx2_fixture("uastc_zstandard"), opaque = ktx2_fixture("uastc_gradient");
  EXPECT_EQ(with_embedded(with_alpha).import().textures.at(0).image().channels, 4);
  EXPECT_EQ(with_embedded(opaque).import().textures.at(0).image().channels, 3);
}

TEST(ImportBasisu, IsHonoredExactly) {
  const SceneDescription scene = with_embedded(ktx2_fixture("etc1s_gradient")).import();
  ASSERT_EQ(scene.features.size(), 1u);
  EXPECT_EQ(scene.features[0].name, "KHR_texture_basisu");
  EXPECT_EQ(scene.features[0].status, FeatureUse::Status::exact);
}

TEST(ImportBasisu, FallsBackWithOneWarningThatSaysWhy) {
  FileBytes broken = ktx2_fixture("etc1s_gradient");
  broken.pop_back();
  for (const bool is_required : {false, true}) {
    GltfFile file = with_embedded(broken);
    add_fallback(file);
    if (is_required) file.json["extensionsRequired"] = {"KHR_texture_basisu"};
    const SceneDescription scene = file.import();
    EXPECT_EQ(scene.textures.at(0).image().values, (std::vector<uint8_t>{0, 255, 0}));
    EXPECT_THAT(warnings(scene),
                ElementsAre(AllOf(HasSubstr("/textures/0: "), HasSubstr("'bark'"), HasSubstr("/images/0"),
                                  HasSubstr("KTX2: the base level lies at"))));
  }
}

TEST(ImportBasisu, OtherFormatsAreNotWhatTheExtensionAllows) {
  // VK_FORMAT_R8G8B8_SRGB
  const FileBytes plain = plain_ktx2(1, 1, 29, {1, 2, 3}, 2);
  GltfFile file = with_embedded(plain);
  add_fallback(file);
  const SceneDescription scene = file.import();
  EXPECT_EQ(scene.textures.at(0).image().values, (std::vector<uint8_t>{0, 255, 0}));
  EXPECT_THAT(warnings(scene), ElementsAre(HasSubstr("the extension allows Basis Universal only")));

  file = with_embedded(plain);
  file.json["textures"][0] = {{"source", 0}};
  const SceneDescription without_extension = file.import();
  EXPECT_EQ(without_extension.textures.at(0).image().values, (std::vector<uint8_t>{1, 2, 3}));
  EXPECT_THAT(warnings(without_extension), IsEmpty());
}

TEST(ImportBasisu, IsAnErrorWhereItIsRequiredAndNothingStandsForIt) {
  GltfFile file = with_embedded(FileBytes(50, 7));
  EXPECT_THAT(warnings(file.import()), ElementsAre(HasSubstr("texture 'bark' cannot be read")));
  file.json["extensionsRequired"] = {"KHR_texture_basisu"};
  EXPECT_THAT(import_error(file), AllOf(HasSubstr("/textures/0: texture 'bark' cannot be read: "),
                                        HasSubstr("/images/0: "), HasSubstr("requires KHR_texture_basisu")));
  file.json["images"][0] = {{"uri", "gone.ktx2"}};
  EXPECT_THAT(import_error(file), HasSubstr("'gone.ktx2' is missing"));
}

TEST(ImportBasisu, TellsATransferFunctionThatIsNotTheUses) {
  const FileBytes srgb = ktx2_fixture("etc1s_gradient"), linear = ktx2_fixture("etc1s_grey");
  const json normal = {{"normalTexture", {{"index", 0}}}};
  EXPECT_THAT(warnings(with_embedded(srgb, base_color).import()), IsEmpty());
  EXPECT_THAT(warnings(with_embedded(linear, normal).import()), IsEmpty());
  EXPECT_THAT(
      warnings(with_embedded(linear, base_color).import()),
      ElementsAre(HasSubstr("texture 'bark' holds colors, which glTF has as sRGB, and is read so; its "
                            "KTX2 file says linear")));
  EXPECT_THAT(warnings(with_embedded(srgb, normal).import()),
              ElementsAre(HasSubstr("its KTX2 file says sRGB")));
  json both = base_color;
  both.update(normal);
  EXPECT_THAT(warnings(with_embedded(srgb, both).import()), ElementsAre(HasSubstr("'bark' holds numbers")));

  const json index = {{"index", 0}};
  const json colors_beside_numbers_in_alpha = {
      {"extensions",
       {{"KHR_materials_sheen", {{"sheenColorTexture", index}, {"sheenRoughnessTexture", index}}},
        {"KHR_materials_specular", {{"specularColorTexture", index}, {"specularTexture", index}}}}}};
  GltfFile file = with_embedded(srgb, colors_beside_numbers_in_alpha);
  EXPECT_THAT(warnings(file.import()), IsEmpty());
}

}  // namespace
}  // namespace vernier::test
