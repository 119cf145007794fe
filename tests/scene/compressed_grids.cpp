// SPDX-License-Identifier: Apache-2.0
#include "tests/scene/compressed_grids.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

namespace vernier::test {

nlohmann::json meshopt_view(int buffer_view_bytes, size_t count, size_t stride, const char* mode,
                            const char* filter) {
  return {{"buffer", 0},          {"byteLength", buffer_view_bytes},
          {"byteStride", stride}, {"count", count},
          {"mode", mode},         {"filter", filter}};
}

GltfFile meshopt_grid(const Grid& grid) {
  const size_t vertices = grid.positions.size() / 3;
  std::vector<uint8_t> packed_positions(meshopt_encodeVertexBufferBound(vertices, 12));
  packed_positions.resize(meshopt_encodeVertexBuffer(packed_positions.data(), packed_positions.size(),
                                                     grid.positions.data(), vertices, 12));
  std::vector<uint8_t> packed_indices(meshopt_encodeIndexBufferBound(grid.indices.size(), vertices));
  packed_indices.resize(meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(),
                                                  grid.indices.data(), grid.indices.size()));
  GltfFile file;
  nlohmann::json position_view = meshopt_view(int(packed_positions.size()), vertices, 12, "ATTRIBUTES");
  nlohmann::json index_view = meshopt_view(int(packed_indices.size()), grid.indices.size(), 4, "TRIANGLES");
  position_view["byteOffset"] = 0;
  file.buffer.assign(packed_positions.begin(), packed_positions.end());
  index_view["byteOffset"] = file.buffer.size();
  file.buffer.append(packed_indices.begin(), packed_indices.end());
  file.json["buffers"] = {
      {{"uri", "data.bin"}, {"byteLength", file.buffer.size()}},
      {{"byteLength", 1 << 20}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  file.add("bufferViews", {{"buffer", 1},
                           {"byteLength", vertices * 12},
                           {"byteStride", 12},
                           {"extensions", {{"EXT_meshopt_compression", position_view}}}});
  file.add("bufferViews", {{"buffer", 1},
                           {"byteLength", grid.indices.size() * 4},
                           {"extensions", {{"EXT_meshopt_compression", index_view}}}});
  file.add("accessors", {{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}});
  file.add("accessors",
           {{"bufferView", 1}, {"componentType", 5125}, {"count", grid.indices.size()}, {"type", "SCALAR"}});
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  file.add_mesh({{"POSITION", 0}}, {{"indices", 1}});
  return file;
}

GltfFile draco_grid(const Grid& grid) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(int(grid.indices.size() / 3));
  const int attribute = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (uint32_t f = 0; f < grid.indices.size() / 3; ++f) {
    const auto corner = [&](uint32_t c) { return &grid.positions[3 * size_t(grid.indices[3 * f + c])]; };
    builder.SetAttributeValuesForFace(attribute, draco::FaceIndex(f), corner(0), corner(1), corner(2));
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
  draco::EncoderBuffer encoded;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &encoded).ok());

  GltfFile file;
  const int view = file.add_view(std::vector<char>(encoded.data(), encoded.data() + encoded.size()));
  const int positions =
      file.add("accessors", {{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}});
  const int indices =
      file.add("accessors", {{"componentType", 5125}, {"count", grid.indices.size()}, {"type", "SCALAR"}});
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const nlohmann::json extension = {{"bufferView", view},
                                    {"attributes", {{"POSITION", mesh->attribute(attribute)->unique_id()}}}};
  file.add_mesh({{"POSITION", positions}},
                {{"indices", indices}, {"extensions", {{"KHR_draco_mesh_compression", extension}}}});
  return file;
}

}  // namespace vernier::test
