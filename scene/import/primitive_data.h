#pragma once

#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// Attributes and triangles of one mesh primitive, however the file stores them.
class PrimitiveData {
 public:
  PrimitiveData(const Document& document, int mesh, int primitive);

  bool has(const std::string& attribute) const;
  /// Components per element of an attribute that is there.
  int components(const std::string& attribute) const;
  size_t vertex_count() const;

  /// All values of an attribute of `V`'s number of float components; throws Error(input) when it is of
  /// another type or is not as long as the positions. V is nothing but floats.
  template <typename V>
  std::vector<V> read(const std::string& attribute) const {
    std::vector<V> values;
    values.reserve(vertex_count() + padding);
    values.resize(vertex_count());
    read_into(attribute, int(sizeof(V) / sizeof(float)), reinterpret_cast<float*>(values.data()));
    return values;
  }

  /// Triangles of lists, strips and fans, counter-clockwise as the file winds them; every index is in range.
  std::vector<Triangle> read_triangles() const;

  /// Throws Error(input) about this primitive; `place` is a JSON pointer below it.
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

 private:
  // Ray tracing kernels load four floats at the last position: room for that is reserved here so that nobody
  // copies.
  static constexpr size_t padding = 2;

  int accessor_of(const std::string& attribute) const;
  void read_into(const std::string& attribute, int components, float* out) const;
  void check_indices(const uint32_t* indices, size_t count) const;

  const Document& document_;
  const tinygltf::Primitive& primitive_;
  std::string place_;
};

/// Whether the primitive has a surface: triangles, strips or fans of at least one triangle, with positions.
bool has_surface(const Document& document, const tinygltf::Primitive& primitive);

}  // namespace vernier
