// SPDX-License-Identifier: Apache-2.0
#include "scene/import/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>
#include <fmt/format.h>

namespace vernier {
namespace {

/// Writes the attribute's value at each point as `components` values of type T.
template <typename T>
bool convert_points(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
                    std::vector<uint8_t>& out) {
  out.resize(size_t(mesh.num_points()) * size_t(components) * sizeof(T));
  T values[16] = {};
  for (uint32_t i = 0; i < mesh.num_points(); ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(i));
    if (!attribute.ConvertValue<T>(index, int8_t(components), values)) return false;
    std::memcpy(out.data() + size_t(i) * size_t(components) * sizeof(T), values,
                size_t(components) * sizeof(T));
  }
  return true;
}

bool convert_points(const draco::Mesh& mesh, const draco::PointAttribute& attribute,
                    const tinygltf::Accessor& accessor, std::vector<uint8_t>& out) {
  const int components = component_count(accessor);
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert_points<int8_t>(mesh, attribute, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert_points<uint8_t>(mesh, attribute, components, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert_points<int16_t>(mesh, attribute, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert_points<uint16_t>(mesh, attribute, components, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert_points<uint32_t>(mesh, attribute, components, out);
    default:
      return convert_points<float>(mesh, attribute, components, out);
  }
}

/// A number as that version of the format writes it.
bool read_number(draco::DecoderBuffer& buffer, uint32_t& value) {
  if (buffer.bitstream_version() < DRACO_BITSTREAM_VERSION(2, 0)) return buffer.Decode(&value);
  return draco::DecodeVarint(&value, &buffer);
}

/// How many faces the data says that it holds, where Draco believes it; nothing where it looks itself or the
/// header is damaged.
std::optional<uint32_t> claimed_faces(draco::DecoderBuffer buffer) {
  draco::DracoHeader header{};
  if (!buffer.Decode(header.draco_string, 5) || !buffer.Decode(&header.version_major) ||
      !buffer.Decode(&header.version_minor) || !buffer.Decode(&header.encoder_type) ||
      !buffer.Decode(&header.encoder_method) || !buffer.Decode(&header.flags))
    return std::nullopt;
  if (header.encoder_type != draco::TRIANGULAR_MESH ||
      header.encoder_method != draco::MESH_EDGEBREAKER_ENCODING)
    return std::nullopt;
  const uint16_t version = DRACO_BITSTREAM_VERSION(header.version_major, header.version_minor);
  buffer.set_bitstream_version(version);
  draco::GeometryMetadata metadata;
  if (version >= DRACO_BITSTREAM_VERSION(1, 3) && header.flags & METADATA_FLAG_MASK &&
      !draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &metadata))
    return std::nullopt;
  uint8_t traversal = 0;
  if (!buffer.Decode(&traversal)) return std::nullopt;
  // Before it stand the number of vertices and, in old versions, that of new ones.
  const int others = version < DRACO_BITSTREAM_VERSION(2, 2) ? 2 : 1;
  uint32_t number = 0;
  for (int i = 0; i <= others; ++i)
    if (!read_number(buffer, number)) return std::nullopt;
  return number;
}

/// Draco makes room for all the faces that its data claims to hold, 32 bytes each, before it reads one of
/// them: a file of 61 bytes asks for gigabytes (google/draco, issue 1169).
void check_claim(const Document& document, const draco::DecoderBuffer& buffer, const std::string& place) {
  // A gigabyte with what is made of them later; and half a bit for each face of what has more.
  constexpr size_t usual = size_t{1} << 23, faces_per_byte = 16;
  const size_t size = size_t(buffer.remaining_size());
  const auto faces = claimed_faces(buffer);
  if (faces && *faces > usual + faces_per_byte * size)
    document.fail(
        place, fmt::format("the compressed data is damaged: {} triangles cannot come out of {} bytes", *faces,
                           size));
}

std::unique_ptr<draco::Mesh> decode_mesh(const Document& document, int view, const std::string& place) {
  const auto bytes = document.view(view);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_claim(document, buffer, place);
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    document.fail(place, fmt::format("the compressed data is damaged: {}", decoded.status().error_msg()));
  return std::move(decoded).value();
}

}  // namespace

DracoData decode_draco(const Document& document, const tinygltf::Primitive& primitive,
                       const std::string& primitive_place) {
  const std::string place = primitive_place + "/extensions/KHR_draco_mesh_compression";
  const auto& accessors = document.model().accessors;
  const auto& extension = primitive.extensions.at("KHR_draco_mesh_compression");
  const auto mesh = decode_mesh(document, extension.Get("bufferView").GetNumberAsInt(), place);

  DracoData data;
  data.indices.reserve(size_t(mesh->num_faces()) * 3);
  for (uint32_t f = 0; f < mesh->num_faces(); ++f)
    for (const auto& point : mesh->face(draco::FaceIndex(f))) data.indices.push_back(point.value());
  if (primitive.indices >= 0 && accessors[size_t(primitive.indices)].count != data.indices.size())
    document.fail(place, fmt::format("{} indices decoded, {} expected", data.indices.size(),
                                     accessors[size_t(primitive.indices)].count));

  const auto& attributes = extension.Get("attributes");
  for (const auto& name : attributes.Keys()) {
    const auto used = primitive.attributes.find(name);
    if (used == primitive.attributes.end()) continue;
    const auto& accessor = accessors[size_t(used->second)];
    const auto* attribute = mesh->GetAttributeByUniqueId(uint32_t(attributes.Get(name).GetNumberAsInt()));
    if (!attribute) document.fail(place, "there is no attribute " + name + " in the compressed data");
    if (mesh->num_points() != accessor.count)
      document.fail(place,
                    fmt::format("{} vertices decoded, {} expected", mesh->num_points(), accessor.count));
    if (!convert_points(*mesh, *attribute, accessor, data.attributes[name]))
      document.fail(place, "attribute " + name + " cannot be converted to its accessor's type");
  }
  return data;
}

}  // namespace vernier
