// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include <cmath>

#include "tests/scene/compressed_grids.h"

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The corners of all triangles, in an order that does not depend on how they are numbered.
std::vector<std::array<float, 9>> sorted_triangles(const std::vector<Vec3f>& positions,
                                                   const std::vector<Triangle>& triangles) {
  std::vector<std::array<float, 9>> sorted;
  for (const auto& t : triangles) {
    // The smallest corner first, winding kept.
    size_t first = 0;
    const auto key = [&](size_t c) {
      const Vec3f& p = positions[t[c % 3]];
      return std::array<float, 3>{p.x, p.y, p.z};
    };
    for (size_t c = 1; c < 3; ++c)
      if (key(c) < key(first)) first = c;
    std::array<float, 9> corners{};
    for (size_t c = 0; c < 3; ++c) std::copy_n(key(first + c).begin(), 3, corners.begin() + 3 * c);
    sorted.push_back(corners);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

std::vector<std::array<float, 9>> sorted_triangles(const Grid& grid) {
  std::vector<Vec3f> positions;
  for (size_t i = 0; i < grid.positions.size(); i += 3)
    positions.emplace_back(grid.positions[i], grid.positions[i + 1], grid.positions[i + 2]);
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < grid.indices.size(); i += 3)
    triangles.push_back({grid.indices[i], grid.indices[i + 1], grid.indices[i + 2]});
  return sorted_triangles(positions, triangles);
}

TEST(ImportCompression, DecodesMeshopt) {
  const Grid grid(17);
  const MeshDescription mesh = meshopt_grid(grid).import().meshes.at(0);
  EXPECT_EQ(sorted_triangles(mesh.positions, mesh.triangles), sorted_triangles(grid));
}

TEST(ImportCompression, DecodesMeshoptFilters) {
  const std::vector<float> normals = {0, 0, 1, 0, 0, 1, .6f, .8f, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1};
  std::vector<float> four_wide(12, 0.f);
  for (size_t i = 0; i < 3; ++i)
    std::copy_n(normals.begin() + 3 * ptrdiff_t(i) + 3, 3, four_wide.begin() + 4 * ptrdiff_t(i));
  std::vector<int16_t> encoded(12);
  meshopt_encodeFilterOct(encoded.data(), 3, 8, 16, four_wide.data());
  std::vector<uint8_t> packed(meshopt_encodeVertexBufferBound(3, 8));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), encoded.data(), 3, 8));

  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int view = file.add_view(packed);
  json compression = meshopt_view(int(packed.size()), 3, 8, "ATTRIBUTES", "OCTAHEDRAL");
  compression["byteOffset"] = file.json["bufferViews"][size_t(view)]["byteOffset"];
  file.json["bufferViews"][size_t(view)] = {{"buffer", 0},
                                            {"byteLength", 24},
                                            {"byteStride", 8},
                                            {"extensions", {{"EXT_meshopt_compression", compression}}}};
  const int accessor = file.add(
      "accessors",
      {{"bufferView", view}, {"componentType", 5122}, {"normalized", true}, {"count", 3}, {"type", "VEC3"}});
  file.add_mesh({{"POSITION", positions}, {"NORMAL", accessor}});
  const auto decoded = file.import().meshes.at(0).normals;
  EXPECT_NEAR(length(decoded.at(1) - Vec3f(.6f, .8f, 0)), 0, 1e-3);
}

TEST(ImportCompression, RejectsDamagedMeshopt) {
  GltfFile file = meshopt_grid(Grid(4));
  file.buffer[0] = 'x';
  EXPECT_THAT(import_error(file),
              HasSubstr("/bufferViews/0/extensions/EXT_meshopt_compression: the compressed data"));
  const auto with = [](const char* property, const json& value) {
    GltfFile changed = meshopt_grid(Grid(4));
    changed.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][property] = value;
    return import_error(changed);
  };
  EXPECT_THAT(with("byteStride", 14), HasSubstr("byteStride must be a multiple of 4"));
  EXPECT_THAT(with("count", 2000000000), HasSubstr("cannot come out of"));
  EXPECT_THAT(with("filter", "QUATERNION"), HasSubstr("byteStride of 8"));
  EXPECT_THAT(with("byteLength", 1 << 20), HasSubstr("are not in buffer 0"));
  EXPECT_THAT(with("count", 24), HasSubstr("/accessors/0: 25 elements need 300 bytes"));
  EXPECT_THAT(with("mode", "TRIANGLES"), HasSubstr("byteStride of indices"));
}

/// The grid with every EXT_meshopt_compression called KHR_meshopt_compression.
GltfFile khr_meshopt_grid(const Grid& grid) {
  GltfFile file = meshopt_grid(grid);
  std::string text = file.json.dump();
  const std::string old = "EXT_meshopt_compression";
  for (size_t at = text.find(old); at != std::string::npos; at = text.find(old))
    text.replace(at, old.size(), "KHR_meshopt_compression");
  file.json = json::parse(text);
  return file;
}

TEST(ImportCompression, DecodesMeshoptByItsNewName) {
  const Grid grid(9);
  const MeshDescription mesh = khr_meshopt_grid(grid).import().meshes.at(0);
  EXPECT_EQ(sorted_triangles(mesh.positions, mesh.triangles), sorted_triangles(grid));
}

TEST(ImportCompression, NamesWhatTheMeshoptLibraryLacks) {
  const auto with = [](const char* property, const json& value) {
    GltfFile file = khr_meshopt_grid(Grid(4));
    file.json["bufferViews"][0]["extensions"]["KHR_meshopt_compression"][property] = value;
    return import_error(file);
  };
  const std::string place = "/bufferViews/0/extensions/KHR_meshopt_compression: ";
  EXPECT_THAT(with("filter", "COLOR"), HasSubstr(place + "filter COLOR is not supported"));
  EXPECT_THAT(with("mode", "CLUSTERS"), HasSubstr(place + "mode CLUSTERS is not supported"));
  GltfFile file = khr_meshopt_grid(Grid(4));
  file.buffer[0] = '\xa7';  // no library knows that version yet
  EXPECT_THAT(import_error(file), HasSubstr(place + "the data is of vertex codec 7"));
}

TEST(ImportCompression, DecodesDraco) {
  const Grid grid(9);
  const MeshDescription mesh = draco_grid(grid).import().meshes.at(0);
  const auto decoded = sorted_triangles(mesh.positions, mesh.triangles), expected = sorted_triangles(grid);
  ASSERT_EQ(decoded.size(), expected.size());
  // Centroids, since quantisation may change which corner is smallest.
  const auto centroids = [](const std::vector<std::array<float, 9>>& triangles) {
    std::vector<std::array<int, 3>> rounded;
    for (const auto& t : triangles) {
      std::array<int, 3> centre{};
      for (size_t c = 0; c < 3; ++c) centre[c] = int(std::lround((t[c] + t[c + 3] + t[c + 6]) / 3 * 1000));
      rounded.push_back(centre);
    }
    std::sort(rounded.begin(), rounded.end());
    return rounded;
  };
  EXPECT_EQ(centroids(decoded), centroids(expected));
}

TEST(ImportCompression, RejectsDamagedDraco) {
  GltfFile file = draco_grid(Grid(3));
  file.json["accessors"][0]["count"] = 5;
  EXPECT_THAT(import_error(file), HasSubstr("vertices decoded, 5 expected"));
  file = draco_grid(Grid(3));
  file.json["accessors"][1]["count"] = 9;
  EXPECT_THAT(import_error(file), HasSubstr("54 indices decoded, 9 expected"));
  file = draco_grid(Grid(3));
  file.buffer.resize(file.buffer.size() / 2);
  file.json["bufferViews"][0]["byteLength"] = file.buffer.size();
  EXPECT_THAT(
      import_error(file),
      HasSubstr(
          "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: the compressed data is damaged"));
}

/// Draco would make room for them all: gigabytes.
TEST(ImportCompression, RejectsMoreTrianglesThanDracoDataCanHold) {
  constexpr size_t flags_at = 10, header_size = 11, triangles_at = 13, symbols_at = 15;
  const std::string many = {'\x80', '\x80', '\x80', '\x80', '\x01'};  // 2^28, seven bits a byte
  GltfFile file = draco_grid(Grid(3));
  ASSERT_EQ(file.buffer[triangles_at], 18);
  file.buffer.replace(symbols_at, 1, many).replace(triangles_at, 1, many);
  file.json["bufferViews"][0]["byteLength"] = file.buffer.size();
  const auto complaint =
      HasSubstr("268435456 triangles cannot come out of " + std::to_string(file.buffer.size()));
  EXPECT_THAT(import_error(file), complaint);
  // The same behind metadata that hold nothing: no attributes, no entries, nothing within.
  file.buffer[flags_at] = '\x80';
  file.buffer.insert(header_size, 3, '\0');
  file.json["bufferViews"][0]["byteLength"] = file.buffer.size();
  EXPECT_THAT(import_error(file), HasSubstr("268435456 triangles cannot come out of "));
}

}  // namespace
}  // namespace vernier::test
