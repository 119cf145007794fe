// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "scene/import/data_uri.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

// What URIs refer to, as browsers and other programs understand them, and texts that are not UTF-8.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string decoded(const std::string& uri) {
  Bytes bytes;
  const std::string problem = decode_data_uri(uri, bytes);
  if (!problem.empty()) return "! " + problem;
  return {bytes.data.get(), bytes.data.get() + bytes.size};
}

TEST(DataUri, ReadsBase64InEveryForm) {
  for (const char* uri :
       {"data:application/octet-stream;base64,Pz8/Pj4+MTI=", "data:;base64,Pz8/Pj4+MTI=",
        "data:;base64,Pz8/Pj4+MTI",
        "data:;BASE64,Pz8/Pj4+MTI=", "DATA:;Base64,Pz8/Pj4+MTI=", "data:;base64,Pz8%2FPj4%2BMTI%3D",
        "data:;base64,Pz8%2fPj4%2bMTI%3d", "data:;base64,Pz8/\nPj4+\r\n MTI=\n",
        "data:;base64,Pz8/%0APj4+%20MTI=", "data:image/png;charset=utf-8;base64,Pz8/Pj4+MTI=",
        "data:text/plain; base64 ,Pz8/Pj4+MTI=", "data:;base64,Pz8/Pj4+MTI=#fragment"})
    EXPECT_EQ(decoded(uri), "\?\?\?>>>12") << uri;
}

TEST(DataUri, ReadsPercentEncodedText) {
  EXPECT_EQ(decoded("data:,a%20b%00c"), std::string("a b\0c", 5));
  EXPECT_EQ(decoded("data:text/plain;charset=US-ASCII,100%"), "100%");
  EXPECT_EQ(decoded("data:text/plain,a,b"), "a,b");
  EXPECT_EQ(decoded("data:base64,QUJD"), "QUJD") << "a media type, not an encoding";
}

TEST(DataUri, SaysWhatIsWrong) {
  EXPECT_EQ(decoded("data:none"), "! data URI without a comma");
  EXPECT_EQ(decoded("data:,"), "! data URI holds no data");
  EXPECT_EQ(decoded("data:;base64,"), "! data URI holds no data");
  for (const char* data : {"A", "AAAAA", "AA=A", "A*==", "AA-_", "AA%ZZ"})
    EXPECT_EQ(decoded("data:;base64," + std::string(data)), "! data URI is not valid base64") << data;
}

GltfFile triangle_with_uri(const std::string& uri) {
  GltfFile file;
  file.add_triangle();
  file.json["buffers"] = {{{"uri", uri}, {"byteLength", file.buffer.size()}}};
  return file;
}

ImportOptions outside_allowed() {
  ImportOptions options;
  options.allow_outside_files = true;
  return options;
}

TEST(References, GoThroughFoldersByName) {
  const TemporaryFolder folder;
  for (const char* uri : {"sub/../data.bin", "./data.bin", "none/../data.bin", "a/b/../../data.bin",
                          "a//../data.bin", "sub%2F..%2Fdata.bin"})
    EXPECT_THAT(import_error(triangle_with_uri(uri).save(folder)), IsEmpty()) << uri;
}

TEST(References, ThatLeaveTheFolderNeedAFlag) {
  const TemporaryFolder folder;
  for (const std::string uri : {"../data.bin", "sub/../../data.bin", "%2e%2e/data.bin", "..\\data.bin"}) {
    const GltfFile file = triangle_with_uri(uri);
    const std::string path = file.save(folder, "scene/scene.gltf");
    std::filesystem::remove(folder.file("scene/data.bin"));
    folder.write("data.bin", file.buffer);
    EXPECT_THAT(import_error(path), HasSubstr("leaves the scene file's folder; put")) << uri;
    EXPECT_THAT(import_error(path), HasSubstr("--allow-outside-files")) << uri;
    EXPECT_THAT(import_error(path, outside_allowed()), IsEmpty()) << uri;
  }
  const GltfFile absolute = triangle_with_uri(folder.file("data.bin"));
  EXPECT_THAT(import_error(absolute.save(folder, "scene/a.gltf")), HasSubstr("--allow-outside-files"));
  EXPECT_THAT(import_error(absolute.save(folder, "scene/a.gltf"), outside_allowed()), IsEmpty());
  const GltfFile remote = triangle_with_uri("https://example.org/data.bin");
  EXPECT_THAT(import_error(remote.save(folder), outside_allowed()), HasSubstr("is not a path relative"));
}

TEST(References, ThatLeaveTheFolderTellNothingOfWhatIsThere) {
  const TemporaryFolder folder;
  const std::string there = import_error(triangle_with_uri("../data.bin").save(folder, "scene/scene.gltf"));
  std::filesystem::remove(folder.file("data.bin"));
  EXPECT_EQ(import_error(triangle_with_uri("../data.bin").save(folder, "scene/scene.gltf")), there);
}

TEST(References, FollowLinksOnlyInside) {
  const TemporaryFolder folder;
  const GltfFile file = triangle_with_uri("sub/data.bin");
  const std::string path = file.save(folder, "scene/scene.gltf");
  std::filesystem::create_directory(folder.file("elsewhere"));
  folder.write("elsewhere/data.bin", file.buffer);
  std::filesystem::create_directory_symlink(folder.file("elsewhere"), folder.file("scene/sub"));
  EXPECT_THAT(import_error(path), HasSubstr("is a link that leaves the scene file's folder"));
  EXPECT_THAT(import_error(path), HasSubstr("--allow-outside-files"));
  EXPECT_THAT(import_error(path, outside_allowed()), IsEmpty());
  // "scene2" begins with the name of the folder and is another.
  std::filesystem::rename(folder.file("elsewhere"), folder.file("scene2"));
  std::filesystem::remove(folder.file("scene/sub"));
  std::filesystem::create_directory_symlink(folder.file("scene2"), folder.file("scene/sub"));
  EXPECT_THAT(import_error(path), HasSubstr("is a link that leaves"));
}

TEST(References, MayBeWrittenOnWindows) {
  const TemporaryFolder folder;
  const GltfFile file = triangle_with_uri("sub\\deep\\data.bin");
  const std::string path = file.save(folder);
  folder.write("sub/deep/data.bin", file.buffer);
  const SceneDescription scene = import_scene(path);
  EXPECT_TRUE(
      has_notice(scene, "'sub\\deep\\data.bin' is written with backslashes; read as 'sub/deep/data.bin'"));
  folder.write("sub\\deep\\data.bin", file.buffer);
  EXPECT_TRUE(import_scene(path).notices.empty()) << "a file of just that name comes first";
  EXPECT_THAT(import_error(triangle_with_uri("C:\\data.bin").save(folder)),
              HasSubstr("is not a path relative"));
}

/// A triangle coloured by the image given.
GltfFile with_image(const json& image) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int texcoords = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("images", image);
  file.add("textures", {{"source", 0}, {"name", "skin"}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", texcoords}}, {{"material", 0}});
  return file;
}

const std::vector<uint8_t> magenta{255, 0, 255};

TEST(References, ToMissingImagesAreMagenta) {
  for (const char* uri : {"gone.png", "no/folder/gone.png", "data:image/png;base64,A", "data:,"}) {
    const SceneDescription scene = with_image({{"uri", uri}}).import();
    EXPECT_EQ(scene.textures.at(0).image().values, magenta) << uri;
    EXPECT_TRUE(has_notice(scene, "texture 'skin' cannot be read")) << uri;
    ImportOptions strict;
    strict.strict = true;
    EXPECT_THAT(import_error(with_image({{"uri", uri}}), strict), HasSubstr("strict: texture 'skin'")) << uri;
  }
  EXPECT_TRUE(has_notice(with_image({{"uri", "gone.png"}}).import(), "'gone.png' is missing"));
  EXPECT_THAT(import_error(with_image({{"uri", "../gone.png"}})), HasSubstr("--allow-outside-files"));
}

TEST(References, ToUnreadableImagesAreNamed) {
  GltfFile file = with_image({{"uri", "cut.png"}});
  file.json["textures"][0].erase("name");
  const TemporaryFolder folder;
  folder.write("cut.png", "not an image at all");
  const SceneDescription scene = import_scene(file.save(folder));
  EXPECT_TRUE(has_notice(scene, "texture cannot be read: "));
  EXPECT_TRUE(has_notice(scene, "/images/0 (cut.png): not a PNG"));
}

TEST(References, ToTruncatedImagesShowWhatThereIs) {
  PngSource source;
  source.samples = {200, 100, 50};
  std::vector<uint8_t> png = png_bytes(source);
  png.resize(png.size() - 12);
  const TemporaryFolder folder;
  folder.write("cut.png", {png.begin(), png.end()});
  const SceneDescription scene = import_scene(with_image({{"uri", "cut.png"}}).save(folder));
  EXPECT_EQ(scene.textures.at(0).image().values, source.samples);
  ASSERT_TRUE(has_notice(scene, "png image is truncated"));
  EXPECT_EQ(scene.notices.back().place, "/images/0");
}

TEST(Texts, OfOtherEncodingsAreNamed) {
  const std::string text = GltfFile().json.dump();
  const auto widened = [&](size_t size, size_t at, const std::string& mark) {
    std::string bytes = mark;
    for (const char c : text) {
      std::string unit(size, '\0');
      unit[at] = c;
      bytes += unit;
    }
    return bytes;
  };
  const TemporaryFolder folder;
  for (const auto& [bytes, name] :
       {std::pair(widened(2, 0, "\xFF\xFE"), "UTF-16"), std::pair(widened(2, 1, "\xFE\xFF"), "UTF-16"),
        std::pair(widened(2, 0, ""), "UTF-16"), std::pair(widened(2, 1, ""), "UTF-16"),
        std::pair(widened(4, 0, std::string("\xFF\xFE\0\0", 4)), "UTF-32"),
        std::pair(widened(4, 3, ""), "UTF-32")})
    EXPECT_THAT(import_error(folder.write("scene.gltf", bytes)),
                HasSubstr(std::string("JSON: the text is ") + name));
  EXPECT_THAT(import_error(folder.write("scene.gltf", "\xEF\xBB\xBF" + text)), IsEmpty())
      << "a mark of UTF-8";
}

TEST(Texts, InMessagesAreOneLineOfUtf8) {
  const TemporaryFolder folder;
  for (const std::string& bytes :
       {std::string("{\"asset\": \xFF\xFF}"), std::string("{\"a\nb\x1b[2J"), std::string("\xC3"),
        std::string("{\"asset\": {\"version\": \"2.0\"}, \"scene\": \"\x7f\"}"),
        std::string("{\"asset\": {\"version\": \"9\\u001b[31m\\n\"}}"),
        std::string("{\"asset\": {\"version\": \"2.0\"}, \"extensionsRequired\": [\"X\\u0007\\u009b\"]}"),
        std::string("{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 1, \"uri\": "
                    "\"%FF%1B.bin\"}]}")}) {
    const std::string error = import_error(folder.write("sc\xFFne\n.gltf", bytes));
    EXPECT_THAT(error, Not(IsEmpty()));
    EXPECT_NO_THROW(json(error).dump()) << "dump() throws on what is not UTF-8";
    for (const char c : error) EXPECT_TRUE(uint8_t(c) >= 0x20 && c != 0x7f) << error;
  }
}

TEST(Texts, RequiredExtensionsAreNamedBeforeAnythingElse) {
  GltfFile file;
  file.json["extensionsRequired"] = {"VENDOR_magic"};
  file.json["buffers"] = {{{"byteLength", 4}}};
  file.json["nodes"] = "none";
  EXPECT_THAT(import_error(file), HasSubstr("/extensionsRequired/0: the file requires VENDOR_magic"));
}

}  // namespace
}  // namespace vernier::test
