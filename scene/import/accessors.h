// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "scene/import/document.h"

namespace vernier {

/// Elements of an accessor as they lie in memory. `bytes` is null when the file gives no data: all zeros.
struct ElementArray {
  const uint8_t* bytes = nullptr;
  size_t count = 0;
  size_t stride = 0;       ///< bytes from one element to the next
  int component_type = 0;  ///< as glTF numbers them: 5120 to 5126
  int components = 0;      ///< 1 to 4; columns of matrices are not told apart
  bool normalized = false;
};

/// Number of components of a glTF accessor type, and bytes of a component.
int component_count(const tinygltf::Accessor& accessor);
size_t component_size(int component_type);

/// The accessor's elements before sparse substitution. Throws Error(input) when they run past their buffer
/// view.
ElementArray locate_elements(const Document& document, int accessor);

/// Writes count x components floats. Normalised integers become [0,1] or [-1,1] (glTF 2.0, 3.6.2.3); other
/// integers keep their value.
void convert_to_floats(const ElementArray& elements, float* out);
/// Writes count unsigned integers; the elements must be scalar and of an unsigned type.
void convert_to_indices(const ElementArray& elements, uint32_t* out);

/// All elements of an accessor, sparse ones substituted. Throws Error(input) unless it has `components`
/// components.
void read_floats(const Document& document, int accessor, int components, float* out);
/// All elements of an accessor of unsigned scalars. Throws Error(input).
void read_indices(const Document& document, int accessor, uint32_t* out);

/// read_floats into vectors, e.g. Vec3f: V is nothing but its float components.
template <typename V>
std::vector<V> read_vectors(const Document& document, int accessor) {
  static_assert(sizeof(V) % sizeof(float) == 0);
  std::vector<V> values(locate_elements(document, accessor).count);
  read_floats(document, accessor, int(sizeof(V) / sizeof(float)), reinterpret_cast<float*>(values.data()));
  return values;
}

}  // namespace vernier
