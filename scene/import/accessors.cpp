// SPDX-License-Identifier: Apache-2.0
#include "scene/import/accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "vernier/error.h"

namespace vernier {
namespace {

/// An accessor without data is all zeros and costs the file nothing; this bounds what it may cost us, a
/// kilobyte an element where these are instances. Next to data it has as many elements as those, of some
/// bytes.
size_t max_elements_without_data(const Document& document) {
  constexpr size_t usual = size_t{1} << 19;
  return std::max(usual, document.buffer_bytes());
}

std::string place_of(int accessor) { return fmt::format("/accessors/{}", accessor); }

template <typename T>
T load(const uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

/// One component as a float (glTF 2.0, 3.6.2.3 for the normalized ones).
template <typename T, bool normalized>
float to_float(T value) {
  if constexpr (std::is_same_v<T, float> || !normalized) return float(value);
  constexpr float largest = float(std::numeric_limits<T>::max());
  return std::max(float(value) / largest, -1.f);
}

template <typename T, bool normalized, int components>
void convert_elements(const ElementArray& elements, float* out) {
  const uint8_t* from = elements.bytes;
  for (size_t i = 0; i < elements.count; ++i, from += elements.stride, out += components)
    for (int c = 0; c < components; ++c)
      out[c] = to_float<T, normalized>(load<T>(from + size_t(c) * sizeof(T)));
}

template <typename T, bool normalized>
void convert_components(const ElementArray& elements, float* out) {
  switch (elements.components) {
    case 1:
      return convert_elements<T, normalized, 1>(elements, out);
    case 2:
      return convert_elements<T, normalized, 2>(elements, out);
    case 3:
      return convert_elements<T, normalized, 3>(elements, out);
    case 4:
      return convert_elements<T, normalized, 4>(elements, out);
    case 16:
      return convert_elements<T, normalized, 16>(elements, out);
    default:
      break;
  }
}

template <typename T>
void convert_type(const ElementArray& elements, float* out) {
  if (elements.normalized)
    convert_components<T, true>(elements, out);
  else
    convert_components<T, false>(elements, out);
}

template <typename T>
void convert_index_type(const ElementArray& elements, uint32_t* out) {
  for (size_t i = 0; i < elements.count; ++i) out[i] = load<T>(elements.bytes + i * elements.stride);
}

/// Elements of a part of an accessor: `count` of them from `offset` on in a buffer view.
ElementArray elements_in_view(const Document& document, const std::string& place, int view, size_t offset,
                              ElementArray shape) {
  const auto bytes = document.view(view);
  const size_t element = component_size(shape.component_type) * size_t(shape.components);
  const size_t view_stride = document.model().bufferViews[size_t(view)].byteStride;
  shape.stride = view_stride ? view_stride : element;
  // count is at most 2^53 and a stride at most 252, so the product stays below 2^61.
  const size_t needed = (shape.count - 1) * shape.stride + element;
  if (offset > bytes.size() || needed > bytes.size() - offset)
    document.fail(place, fmt::format("{} elements need {} bytes from byte {} on, but bufferView {} has {}",
                                     shape.count, needed, offset, view, bytes.size()));
  shape.bytes = bytes.data() + offset;
  return shape;
}

/// Calls substitute(index, source element) for each sparse element.
template <typename Substitute>
void for_each_sparse(const Document& document, int index, const Substitute& substitute) {
  const auto& accessor = document.model().accessors[size_t(index)];
  if (!accessor.sparse.isSparse) return;
  const std::string place = place_of(index) + "/sparse";
  ElementArray index_shape;
  index_shape.count = size_t(accessor.sparse.count);
  index_shape.components = 1;
  index_shape.component_type = accessor.sparse.indices.componentType;
  const ElementArray indices =
      elements_in_view(document, place + "/indices", accessor.sparse.indices.bufferView,
                       size_t(accessor.sparse.indices.byteOffset), index_shape);
  ElementArray value_shape = locate_elements(document, index);
  value_shape.count = index_shape.count;
  const ElementArray values = elements_in_view(document, place + "/values", accessor.sparse.values.bufferView,
                                               size_t(accessor.sparse.values.byteOffset), value_shape);
  std::vector<uint32_t> targets(indices.count);
  convert_to_indices(indices, targets.data());
  ElementArray one = values;
  one.count = 1;
  for (size_t i = 0; i < targets.size(); ++i) {
    if (targets[i] >= accessor.count)
      document.fail(place + "/indices",
                    fmt::format("sparse index {} of an accessor of {} elements", targets[i], accessor.count));
    one.bytes = values.bytes + i * values.stride;
    substitute(targets[i], one);
  }
}

}  // namespace

int component_count(const tinygltf::Accessor& accessor) {
  switch (accessor.type) {
    case TINYGLTF_TYPE_SCALAR:
      return 1;
    case TINYGLTF_TYPE_VEC2:
      return 2;
    case TINYGLTF_TYPE_VEC3:
      return 3;
    case TINYGLTF_TYPE_VEC4:
    case TINYGLTF_TYPE_MAT2:
      return 4;
    case TINYGLTF_TYPE_MAT3:
      return 9;
    default:
      return 16;
  }
}

size_t component_size(int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    default:
      return 4;
  }
}

ElementArray locate_elements(const Document& document, int index) {
  const auto& accessor = document.model().accessors[size_t(index)];
  ElementArray elements;
  elements.count = accessor.count;
  elements.component_type = accessor.componentType;
  elements.components = component_count(accessor);
  elements.normalized = accessor.normalized;
  if (accessor.bufferView >= 0)
    return elements_in_view(document, place_of(index), accessor.bufferView, accessor.byteOffset, elements);
  if (const size_t most = max_elements_without_data(document); accessor.count > most)
    document.fail(place_of(index) + "/count",
                  fmt::format("{} elements without a bufferView; at most {} are read", accessor.count, most));
  return elements;
}

void convert_to_floats(const ElementArray& elements, float* out) {
  const size_t values = elements.count * size_t(elements.components);
  if (!elements.bytes) {
    std::fill_n(out, values, 0.f);
    return;
  }
  switch (elements.component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return convert_type<int8_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert_type<uint8_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return convert_type<int16_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert_type<uint16_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return convert_type<uint32_t>(elements, out);
    default:
      break;
  }
  if (elements.stride == sizeof(float) * size_t(elements.components))
    std::memcpy(out, elements.bytes, values * sizeof(float));
  else
    convert_type<float>(elements, out);
}

void convert_to_indices(const ElementArray& elements, uint32_t* out) {
  if (!elements.bytes) {
    std::fill_n(out, elements.count, 0u);
    return;
  }
  switch (elements.component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return convert_index_type<uint8_t>(elements, out);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return convert_index_type<uint16_t>(elements, out);
    default:
      return convert_index_type<uint32_t>(elements, out);
  }
}

void read_floats(const Document& document, int accessor, int components, float* out) {
  const ElementArray elements = locate_elements(document, accessor);
  if (elements.components != components)
    document.fail(place_of(accessor) + "/type", fmt::format("expected {} components for this use, found {}",
                                                            components, elements.components));
  convert_to_floats(elements, out);
  for_each_sparse(document, accessor, [&](size_t target, const ElementArray& value) {
    convert_to_floats(value, out + target * size_t(components));
  });
}

void read_indices(const Document& document, int accessor, uint32_t* out) {
  const ElementArray elements = locate_elements(document, accessor);
  const bool is_unsigned = elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           elements.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (elements.components != 1 || !is_unsigned)
    document.fail(place_of(accessor), "expected scalars of type 5121, 5123 or 5125 for indices");
  convert_to_indices(elements, out);
  for_each_sparse(document, accessor,
                  [&](size_t target, const ElementArray& value) { convert_to_indices(value, out + target); });
}

}  // namespace vernier
