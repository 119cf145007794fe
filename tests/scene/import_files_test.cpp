// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/scene/import_support.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle whose buffer has the given URI.
GltfFile triangle_with_uri(const std::string& uri) {
  GltfFile file;
  file.add_triangle();
  file.json["buffers"] = {{{"uri", uri}, {"byteLength", file.buffer.size()}}};
  return file;
}

std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? uint8_t(bytes[i + k]) : 0);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

TEST(ImportFiles, ReadsBuffersBesideTheScene) {
  const TemporaryFolder folder;
  const SceneDescription scene = import_scene(triangle_with_uri("data.bin").save(folder));
  ASSERT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.meshes[0].positions[1], Vec3f(1, 0, 0));
}

TEST(ImportFiles, ReadsDataUris) {
  GltfFile file;
  file.add_triangle();
  for (size_t extra = 0; extra < 3; ++extra) {
    const std::string bytes = file.buffer + std::string(extra, 'x');
    file.json["buffers"] = {
        {{"uri", "data:application/octet-stream;base64," + base64(bytes)}, {"byteLength", bytes.size()}}};
    EXPECT_EQ(file.import().meshes.at(0).positions[2], Vec3f(0, 1, 0)) << extra;
  }
}

TEST(ImportFiles, RejectsBadDataUris) {
  EXPECT_THAT(import_error(triangle_with_uri("data:application/octet-stream;base64,A*==")),
              HasSubstr("base64"));
  EXPECT_THAT(import_error(triangle_with_uri("data:application/octet-stream;base64,AAAAA")),
              HasSubstr("base64"));
  EXPECT_THAT(import_error(triangle_with_uri("data:;base64,AAAA")),
              HasSubstr("36 bytes expected, there are 3"));
  EXPECT_THAT(import_error(triangle_with_uri("data:nothing")), HasSubstr("comma"));
}

TEST(ImportFiles, DecodesPercentSigns) {
  const TemporaryFolder folder;
  const GltfFile file = triangle_with_uri("my%20data+%C3%A9.bin");
  folder.write("my data+\xC3\xA9.bin", file.buffer);
  EXPECT_THAT(import_error(file.save(folder)), IsEmpty());
}

TEST(ImportFiles, StaysInsideTheScenesFolder) {
  const TemporaryFolder folder;
  for (const char* uri :
       {"../data.bin", "%2e%2e/data.bin", "sub/../../data.bin", "%2E%2E%2Fdata.bin", "/etc/passwd",
        "file:///etc/passwd", "http://example.org/data.bin", "%2Fetc/passwd"}) {
    const GltfFile file = triangle_with_uri(uri);
    folder.write("data.bin", file.buffer);
    EXPECT_THAT(import_error(file.save(folder, "scene/scene.gltf")),
                HasSubstr("/buffers/0/uri: '" + std::string(uri)));
  }
}

TEST(ImportFiles, RejectsLinksThatLeaveTheFolder) {
  const TemporaryFolder folder;
  const GltfFile file = triangle_with_uri("link.bin");
  const std::string path = file.save(folder, "scene/scene.gltf");
  std::filesystem::create_symlink(folder.file("data.bin"), folder.file("scene/link.bin"));
  EXPECT_THAT(import_error(path), HasSubstr("link that leaves"));
  std::filesystem::remove(folder.file("scene/link.bin"));
  folder.write("scene/other.bin", file.buffer);
  std::filesystem::create_symlink("other.bin", folder.file("scene/link.bin"));
  EXPECT_THAT(import_error(path), IsEmpty());
}

TEST(ImportFiles, ReadsRegularFilesOnly) {
  const TemporaryFolder folder;
  const std::string path = triangle_with_uri("pipe.bin").save(folder);
  ASSERT_EQ(mkfifo(folder.file("pipe.bin").c_str(), 0600), 0);
  EXPECT_THAT(import_error(path), HasSubstr("not a regular file"));
  EXPECT_THAT(import_error(folder.file("pipe.bin")), HasSubstr("not a regular file"));
  EXPECT_THAT(import_error(folder.file("")), HasSubstr("not a regular file"));
  EXPECT_THAT(import_error("/dev/zero"), HasSubstr("not a regular file"));
}

TEST(ImportFiles, NamesWhatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_THAT(import_error(folder.file("none.glb")), HasSubstr("none.glb: cannot be read: No such file"));
  EXPECT_THAT(import_error(folder.file("no/folder/none.glb")),
              HasSubstr("none.glb: cannot be read: No such file"));
  const std::string error = import_error(triangle_with_uri("gone.bin").save(folder));
  EXPECT_THAT(error, HasSubstr("/buffers/0/uri: 'gone.bin' is missing: No such file"));
  folder.write("empty.gltf", "");
  EXPECT_THAT(import_error(folder.file("empty.gltf")), HasSubstr("empty"));
}

TEST(ImportFiles, ReadsGlb) {
  GltfFile file;
  file.add_triangle();
  const TemporaryFolder folder;
  const SceneDescription scene = import_scene(folder.write("scene.glb", file.glb()));
  EXPECT_EQ(scene.meshes.at(0).positions[1], Vec3f(1, 0, 0));
}

TEST(ImportFiles, RejectsEveryTruncationOfAGlb) {
  GltfFile file;
  file.add_triangle();
  const std::string bytes = file.glb();
  const TemporaryFolder folder;
  for (size_t length = 0; length < bytes.size(); ++length) {
    const std::string path = folder.write("scene.glb", bytes.substr(0, length));
    EXPECT_THAT(import_error(path), testing::StartsWith(path + ": ")) << length;
  }
}

TEST(ImportFiles, RejectsChunksThatRunPastTheEnd) {
  GltfFile file;
  file.add_triangle();
  const TemporaryFolder folder;
  std::string bytes = file.glb();
  const size_t binary_header = bytes.size() - file.buffer.size() - 8;
  // Eight bytes more than there are, which a check that forgets the chunk's own header lets through, and 2^32
  // - 1.
  for (const uint32_t length :
       {uint32_t(file.buffer.size() + 4), uint32_t(file.buffer.size() + 8), 0xFFFFFFFFu}) {
    bytes.replace(binary_header, 4, GltfFile::word(length));
    EXPECT_THAT(import_error(folder.write("scene.glb", bytes)), HasSubstr("past the end")) << length;
  }
  bytes.replace(12, 4, GltfFile::word(0xFFFFFFFFu));
  EXPECT_THAT(import_error(folder.write("scene.glb", bytes)), HasSubstr("past the end"));
}

TEST(ImportFiles, ReportsJsonErrorsOnOneLine) {
  const TemporaryFolder folder;
  const std::string error = import_error(folder.write("scene.gltf", "{\n  \"asset\": {\n"));
  EXPECT_THAT(error, HasSubstr("JSON: parse error at line 3"));
  EXPECT_EQ(error.find('\n'), std::string::npos);
  EXPECT_THAT(import_error(folder.write("scene.gltf", "[]")), HasSubstr("expected an object"));
}

TEST(ImportFiles, SurvivesDeepNesting) {
  const TemporaryFolder folder;
  const std::string open(100000, '['), close(100000, ']');
  EXPECT_THAT(import_error(folder.write("scene.gltf", "{\"extras\": " + open + close + "}")),
              HasSubstr("nested deeper"));
  // Brackets in strings are not nesting.
  EXPECT_THAT(
      import_error(folder.write("a.gltf", R"({"asset": {"version": "2.0"}, "extras": "\")" + open + "\"}")),
      IsEmpty());
}

TEST(ImportFiles, RefusesOtherVersions) {
  const TemporaryFolder folder;
  EXPECT_THAT(import_error(folder.write("a.gltf", R"({"asset": {"version": "1.0"}, "buffers": {}})")),
              HasSubstr("/asset/version: glTF 1.0 cannot be read"));
  EXPECT_THAT(import_error(folder.write("b.gltf", R"({"asset": {"version": "2.1", "minVersion": "2.1"}})")),
              HasSubstr("glTF 2.1 cannot be read"));
  EXPECT_THAT(import_error(folder.write("c.gltf", R"({"asset": {"version": "2.1", "minVersion": "2.0"}})")),
              IsEmpty());
}

TEST(ImportFiles, HashCoversEveryFile) {
  const TemporaryFolder folder;
  const GltfFile file = triangle_with_uri("data.bin");
  const std::string path = file.save(folder);
  const std::string hash = import_scene(path).hash;
  EXPECT_EQ(hash.size(), 32u);
  EXPECT_EQ(import_scene(path).hash, hash);
  std::string changed = file.buffer;
  changed.back() ^= 1;
  folder.write("data.bin", changed);
  EXPECT_NE(import_scene(path).hash, hash);
}

}  // namespace
}  // namespace vernier::test
