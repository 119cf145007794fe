// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/draco.h"
#include "vernier/scene.h"

namespace vernier {

/// What a primitive is made of.
enum class Topology { none, points, lines, triangles };

/// None when it has no positions, or too few for one point, line or triangle.
Topology topology_of(const Document& document, const tinygltf::Primitive& primitive);

/// Attributes and triangles of one mesh primitive, however the file stores them.
class PrimitiveData {
 public:
  PrimitiveData(const Document& document, int mesh, int primitive);

  bool has(const std::string& attribute) const;
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

  /// COLOR_0, which is there; of three components: with alpha 1.
  std::vector<Vec4f> read_colors() const;

  size_t target_count() const { return primitive_.targets.size(); }
  /// A morph target's values for an attribute; empty when it has none. Throws Error(input) as read() does.
  template <typename V>
  std::vector<V> read_target(size_t target, const std::string& attribute) const {
    const auto found = primitive_.targets[target].find(attribute);
    if (found == primitive_.targets[target].end()) return {};
    check_target(target, attribute, found->second);
    return read_vectors<V>(document_, found->second);
  }

  /// A morph target's changes of COLOR_0, of three components: with none of alpha; empty when it has none.
  std::vector<Vec4f> read_target_colors(size_t target) const;

  /// Triangles of lists, strips and fans, counter-clockwise as the file winds them; every index is in range.
  std::vector<Triangle> read_triangles() const;
  /// Points and lines as triangles without area, {a, a, a} and {a, b, b}; every index is in range.
  std::vector<Triangle> read_thin() const;

  /// Throws Error(input) about this primitive; `place` is a JSON pointer below it.
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

 private:
  // Ray tracing kernels load four floats at the last position: room for that is reserved here so that nobody
  // copies.
  static constexpr size_t padding = 2;

  int components(int accessor) const;
  int accessor_of(const std::string& attribute) const;
  /// Indices that the primitive draws, whatever its mode.
  std::vector<uint32_t> drawn_indices() const;
  void read_into(const std::string& attribute, int components, float* out) const;
  void check_target(size_t target, const std::string& attribute, int accessor) const;
  void check_indices(const uint32_t* indices, size_t count) const;

  const Document& document_;
  const tinygltf::Primitive& primitive_;
  std::string place_;
  std::optional<DracoData> draco_;
};

}  // namespace vernier
