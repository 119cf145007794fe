// SPDX-License-Identifier: Apache-2.0
#include "scene/import/primitive_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scene/import/accessors.h"

namespace vernier {
namespace {

const char* const draco_extension = "KHR_draco_mesh_compression";

/// Number of indices that a primitive draws.
size_t index_count(const Document& document, const tinygltf::Primitive& primitive) {
  const int accessor = primitive.indices >= 0 ? primitive.indices : primitive.attributes.at("POSITION");
  return document.model().accessors[size_t(accessor)].count;
}

std::vector<Vec4f> with_alpha(const std::vector<Vec3f>& colors, float alpha) {
  std::vector<Vec4f> result;
  result.reserve(colors.size());
  for (const auto& c : colors) result.emplace_back(c.x, c.y, c.z, alpha);
  return result;
}

/// The i-th triangle of a strip or fan, wound as glTF 2.0, 3.7.2.1 has it.
Triangle connected_triangle(int mode, const std::vector<uint32_t>& indices, size_t i) {
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {indices[i + 1], indices[i + 2], indices[0]};
  return {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
}

}  // namespace

Topology topology_of(const Document& document, const tinygltf::Primitive& primitive) {
  if (!primitive.attributes.count("POSITION")) return Topology::none;
  const size_t count = index_count(document, primitive);
  if (primitive.mode == TINYGLTF_MODE_POINTS) return Topology::points;
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) return count >= 2 ? Topology::lines : Topology::none;
  return count >= 3 ? Topology::triangles : Topology::none;
}

PrimitiveData::PrimitiveData(const Document& document, int mesh, int primitive)
    : document_(document),
      primitive_(document.model().meshes[size_t(mesh)].primitives[size_t(primitive)]),
      place_(fmt::format("/meshes/{}/primitives/{}", mesh, primitive)) {
  if (primitive_.extensions.count(draco_extension)) draco_ = decode_draco(document, primitive_, place_);
}

bool PrimitiveData::has(const std::string& attribute) const {
  return primitive_.attributes.count(attribute) > 0;
}

int PrimitiveData::accessor_of(const std::string& attribute) const {
  return primitive_.attributes.at(attribute);
}

int PrimitiveData::components(int accessor) const {
  return component_count(document_.model().accessors[size_t(accessor)]);
}

size_t PrimitiveData::vertex_count() const {
  const int accessor = accessor_of("POSITION");
  // Data out of compression has been compared with the accessor's count; other data is bounded by its buffer
  // view.
  if (draco_ && draco_->attributes.count("POSITION"))
    return document_.model().accessors[size_t(accessor)].count;
  return locate_elements(document_, accessor).count;
}

void PrimitiveData::read_into(const std::string& attribute, int components, float* out) const {
  const auto& accessor = document_.model().accessors[size_t(accessor_of(attribute))];
  if (accessor.count != vertex_count())
    fail("/attributes/" + attribute,
         fmt::format("{} values for {} positions", accessor.count, vertex_count()));
  if (component_count(accessor) != components)
    fail("/attributes/" + attribute,
         fmt::format("expected {} components, found {}", components, component_count(accessor)));
  if (!draco_ || !draco_->attributes.count(attribute)) {
    read_floats(document_, accessor_of(attribute), components, out);
    return;
  }
  ElementArray elements;
  elements.bytes = draco_->attributes.at(attribute).data();
  elements.count = accessor.count;
  elements.component_type = accessor.componentType;
  elements.components = components;
  elements.normalized = accessor.normalized;
  elements.stride = component_size(accessor.componentType) * size_t(components);
  convert_to_floats(elements, out);
}

std::vector<Vec4f> PrimitiveData::read_colors() const {
  if (components(accessor_of("COLOR_0")) != 3) return read<Vec4f>("COLOR_0");
  return with_alpha(read<Vec3f>("COLOR_0"), 1);
}

std::vector<Vec4f> PrimitiveData::read_target_colors(size_t target) const {
  const auto found = primitive_.targets[target].find("COLOR_0");
  if (found == primitive_.targets[target].end() || components(found->second) != 3)
    return read_target<Vec4f>(target, "COLOR_0");
  return with_alpha(read_target<Vec3f>(target, "COLOR_0"), 0);
}

std::vector<Triangle> PrimitiveData::read_triangles() const {
  const bool list = primitive_.mode == TINYGLTF_MODE_TRIANGLES || draco_;
  if (list && !draco_ && primitive_.indices >= 0 && index_count(document_, primitive_) % 3 == 0) {
    // By far the most common case, without a copy.
    std::vector<Triangle> triangles(locate_elements(document_, primitive_.indices).count / 3);
    read_indices(document_, primitive_.indices, triangles.data()->data());
    check_indices(triangles.data()->data(), triangles.size() * 3);
    return triangles;
  }
  const std::vector<uint32_t> indices = drawn_indices();
  check_indices(indices.data(), indices.size());
  std::vector<Triangle> triangles(list ? indices.size() / 3 : indices.size() - 2);
  for (size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = list ? Triangle{indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]}
                        : connected_triangle(primitive_.mode, indices, i);
  return triangles;
}

std::vector<Triangle> PrimitiveData::read_thin() const {
  const std::vector<uint32_t> indices = drawn_indices();
  check_indices(indices.data(), indices.size());
  std::vector<Triangle> elements;
  elements.reserve(indices.size());
  const auto add_line = [&](uint32_t a, uint32_t b) { elements.push_back({a, b, b}); };
  if (primitive_.mode == TINYGLTF_MODE_POINTS)
    for (const uint32_t i : indices) elements.push_back({i, i, i});
  if (primitive_.mode == TINYGLTF_MODE_LINE)
    for (size_t i = 1; i < indices.size(); i += 2) add_line(indices[i - 1], indices[i]);
  if (primitive_.mode == TINYGLTF_MODE_LINE_STRIP || primitive_.mode == TINYGLTF_MODE_LINE_LOOP)
    for (size_t i = 1; i < indices.size(); ++i) add_line(indices[i - 1], indices[i]);
  if (primitive_.mode == TINYGLTF_MODE_LINE_LOOP) add_line(indices.back(), indices.front());
  return elements;
}

std::vector<uint32_t> PrimitiveData::drawn_indices() const {
  if (draco_) return draco_->indices;
  std::vector<uint32_t> indices;
  if (primitive_.indices >= 0) {
    indices.resize(locate_elements(document_, primitive_.indices).count);
    read_indices(document_, primitive_.indices, indices.data());
  } else {
    indices.resize(vertex_count());
    std::iota(indices.begin(), indices.end(), 0u);
  }
  return indices;
}

void PrimitiveData::check_target(size_t target, const std::string& attribute, int accessor) const {
  const size_t count = document_.model().accessors[size_t(accessor)].count;
  if (count != vertex_count())
    fail(fmt::format("/targets/{}/{}", target, attribute),
         fmt::format("{} values for {} positions", count, vertex_count()));
}

void PrimitiveData::check_indices(const uint32_t* indices, size_t count) const {
  const size_t vertices = vertex_count();
  uint32_t largest = 0;
  for (size_t i = 0; i < count; ++i) largest = std::max(largest, indices[i]);
  if (largest < vertices) return;
  const auto* first = std::find_if(indices, indices + count, [&](uint32_t i) { return i >= vertices; });
  fail("/indices", fmt::format("index {} at position {} is out of range, there are {} vertices", *first,
                               first - indices, vertices));
}

void PrimitiveData::fail(const std::string& place, const std::string& problem) const {
  document_.fail(place_ + place, problem);
}

}  // namespace vernier
