// SPDX-License-Identifier: Apache-2.0
#include "scene/import/draco.h"

#include <draco/compression/decode.h>
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

std::unique_ptr<draco::Mesh> decode_mesh(const Document& document, int view, const std::string& place) {
  const auto bytes = document.view(view);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
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
