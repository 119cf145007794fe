// SPDX-License-Identifier: Apache-2.0
#include "vernier/scene_file.h"

#include <gtest/gtest.h>

#include "core/image/image_io.h"
#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

/// A textured triangle that moves, one that a joint moves, and one that a morph target moves, within 1 s.
GltfFile moving_scene() {
  GltfFile file;
  Image8 picture(2, 2, 3);
  picture.values[0] = 200;
  const std::vector<unsigned char> png = encode_image8("png", picture);
  file.add("images", {{"bufferView", file.add_view(png)}, {"mimeType", "image/png"}});
  file.add("textures", {{"source", 0}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  const int moved = file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, {{"material", 0}});
  const int joints = file.add_accessor(std::vector<uint8_t>(12, 0), "VEC4");
  const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  const int skinned = file.add_mesh({{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
  file.add("skins", {{"joints", {moved}}});
  file.json["nodes"][size_t(skinned)]["skin"] = 0;
  const int offsets = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int morphed = file.add_mesh({{"POSITION", positions}}, {{"targets", {{{"POSITION", offsets}}}}});
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const int places = file.add_accessor(std::vector<float>{0, 0, 0, 4, 0, 0}, "VEC3");
  const int factors = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  file.add("animations",
           {{"channels",
             {{{"sampler", 0}, {"target", {{"node", moved}, {"path", "translation"}}}},
              {{"sampler", 1}, {"target", {{"node", morphed}, {"path", "weights"}}}}}},
            {"samplers", {{{"input", times}, {"output", places}}, {{"input", times}, {"output", factors}}}}});
  return file;
}

void expect_same(const SceneDescription& a, const SceneDescription& b) {
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_EQ(a.choices, b.choices);
  ASSERT_EQ(a.meshes.size(), b.meshes.size());
  for (size_t i = 0; i < a.meshes.size(); ++i) {
    EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions) << i;
    EXPECT_EQ(a.meshes[i].triangles, b.meshes[i].triangles) << i;
    EXPECT_EQ(a.meshes[i].texcoords, b.meshes[i].texcoords) << i;
  }
  ASSERT_EQ(a.instances.size(), b.instances.size());
  for (size_t i = 0; i < a.instances.size(); ++i) EXPECT_EQ(a.instances[i].to_world, b.instances[i].to_world);
  ASSERT_EQ(a.textures.size(), b.textures.size());
  for (size_t i = 0; i < a.textures.size(); ++i)
    EXPECT_EQ(a.textures[i].image().values, b.textures[i].image().values);
  ASSERT_EQ(a.notices.size(), b.notices.size());
  for (size_t i = 0; i < a.notices.size(); ++i) EXPECT_EQ(a.notices[i].text, b.notices[i].text);
}

std::span<const uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

TEST(SceneFile, DescribesTheSameAsReadingAnewAtAnyTime) {
  const TemporaryFolder folder;
  const std::string path = moving_scene().save(folder);
  SceneFile file(path);
  for (const double time : {0.25, 0.75, 0.75, 0.0, 9.0}) {
    ImportOptions options;
    options.time = time;
    expect_same(file.describe(options), import_scene(path, options));
  }
  expect_same(file.describe(), import_scene(path));
}

TEST(SceneFile, KeepsWhatDoesNotDependOnTime) {
  const TemporaryFolder folder;
  const std::string path = moving_scene().save(folder);
  SceneFile file(path);
  ImportOptions options;
  const SceneDescription rest = file.describe(options);
  std::filesystem::remove(folder.file("data.bin"));
  std::filesystem::remove(path);
  options.time = 0.5;
  const SceneDescription later = file.describe(options);
  ASSERT_EQ(later.textures.size(), 1u);
  EXPECT_EQ(&later.textures[0].image(), &rest.textures[0].image());
  EXPECT_EQ(later.instances[0].to_world.origin.x, 2.f);
  EXPECT_EQ(later.meshes[1].positions[0].x, 2.f) << "a joint moves it";
  EXPECT_EQ(later.meshes[2].positions[0].z, 0.5f) << "a morph target moves it";
}

TEST(SceneFile, NamesItsVariants) {
  GltfFile file = moving_scene();
  const TemporaryFolder folder;
  EXPECT_TRUE(SceneFile(file.save(folder)).variants().empty());
  file.json["extensionsUsed"] = {"KHR_materials_variants"};
  file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "b"}}, {{"name", "a"}}};
  EXPECT_EQ(SceneFile(file.save(folder)).variants(), (std::vector<std::string>{"b", "a"}));
}

TEST(SceneFile, IsTheSameFromMemory) {
  const TemporaryFolder folder;
  std::string bytes = moving_scene().glb();
  const std::string path = folder.write("scene.glb", bytes);
  SceneFile file("a name", as_bytes(bytes));
  std::fill(bytes.begin(), bytes.end(), '\0');  // they may go
  const SceneDescription description = file.describe();
  expect_same(description, import_scene(path));
  EXPECT_EQ(description.source, "a name");
}

TEST(SceneFile, InMemoryRefersToNoFiles) {
  const TemporaryFolder folder;
  const std::string bytes = read_file(moving_scene().save(folder));
  try {
    SceneFile("memory", as_bytes(bytes)).describe();
    FAIL() << "data.bin is in no folder";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(std::string(error.what()).find("memory: /buffers/0/uri: 'data.bin' is another file"), 0u)
        << error.what();
  }
}

}  // namespace
}  // namespace vernier::test
