#include "scene/import/primitive_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scene/import/accessors.h"

namespace vernier {
namespace {

/// Indices that a primitive draws.
size_t index_count(const Document& document, const tinygltf::Primitive& primitive) {
  const int accessor = primitive.indices >= 0 ? primitive.indices : primitive.attributes.at("POSITION");
  return document.model().accessors[size_t(accessor)].count;
}

/// The i-th triangle of a strip or fan, wound as glTF 2.0, 3.7.2.1 has it.
Triangle connected_triangle(int mode, const std::vector<uint32_t>& indices, size_t i) {
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {indices[i + 1], indices[i + 2], indices[0]};
  return {indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]};
}

}  // namespace

bool has_surface(const Document& document, const tinygltf::Primitive& primitive) {
  const bool triangles =
      primitive.mode >= TINYGLTF_MODE_TRIANGLES && primitive.mode <= TINYGLTF_MODE_TRIANGLE_FAN;
  return triangles && primitive.attributes.count("POSITION") && index_count(document, primitive) >= 3;
}

PrimitiveData::PrimitiveData(const Document& document, int mesh, int primitive)
    : document_(document),
      primitive_(document.model().meshes[size_t(mesh)].primitives[size_t(primitive)]),
      place_(fmt::format("/meshes/{}/primitives/{}", mesh, primitive)) {}

bool PrimitiveData::has(const std::string& attribute) const {
  return primitive_.attributes.count(attribute) > 0;
}

int PrimitiveData::accessor_of(const std::string& attribute) const {
  return primitive_.attributes.at(attribute);
}

int PrimitiveData::components(const std::string& attribute) const {
  return component_count(document_.model().accessors[size_t(accessor_of(attribute))]);
}

size_t PrimitiveData::vertex_count() const {
  return locate_elements(document_, accessor_of("POSITION")).count;
}

void PrimitiveData::read_into(const std::string& attribute, int components, float* out) const {
  const size_t count = document_.model().accessors[size_t(accessor_of(attribute))].count;
  if (count != vertex_count())
    fail("/attributes/" + attribute, fmt::format("{} values for {} positions", count, vertex_count()));
  read_floats(document_, accessor_of(attribute), components, out);
}

std::vector<Triangle> PrimitiveData::read_triangles() const {
  const size_t count = index_count(document_, primitive_);
  const bool list = primitive_.mode == TINYGLTF_MODE_TRIANGLES;
  std::vector<Triangle> triangles(list ? count / 3 : count - 2);
  std::vector<uint32_t> indices;
  const bool in_place = list && count % 3 == 0;
  if (!in_place) indices.resize(count);
  uint32_t* target = in_place ? triangles.data()->data() : indices.data();
  if (primitive_.indices >= 0)
    read_indices(document_, primitive_.indices, target);
  else
    std::iota(target, target + count, 0u);
  check_indices(target, count);
  if (in_place) return triangles;
  for (size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = list ? Triangle{indices[3 * i], indices[3 * i + 1], indices[3 * i + 2]}
                        : connected_triangle(primitive_.mode, indices, i);
  return triangles;
}

void PrimitiveData::check_indices(const uint32_t* indices, size_t count) const {
  const size_t vertices = vertex_count();
  uint32_t largest = 0;
  for (size_t i = 0; i < count; ++i) largest = std::max(largest, indices[i]);
  if (largest < vertices) return;
  const size_t first =
      size_t(std::find_if(indices, indices + count, [&](uint32_t i) { return i >= vertices; }) - indices);
  fail("/indices", fmt::format("index {} at position {} is out of range, there are {} vertices",
                               indices[first], first, vertices));
}

void PrimitiveData::fail(const std::string& place, const std::string& problem) const {
  document_.fail(place_ + place, problem);
}

}  // namespace vernier
