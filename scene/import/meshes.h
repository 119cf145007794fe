// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>

#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/primitive_data.h"
#include "vernier/scene.h"

namespace vernier {

/// A mesh primitive in one shape. Nodes that agree in all of this share the triangles.
struct MeshUse {
  int mesh = 0, primitive = 0;
  int skin = -1;                ///< the mesh is then in world space
  std::vector<double> weights;  ///< of morph targets

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 reads what the compiler writes
  auto operator<=>(const MeshUse&) const = default;
};

struct MeshRequest {
  MeshUse use;
  Topology topology = Topology::triangles;
  std::vector<int> texcoords{-1, -1};     ///< n of the TEXCOORD_n to read as the sets there; -1: none
  std::optional<TextureUse> tangent_map;  ///< the texture whose axes tangents follow; none: they are not read
};

/// Whether two requests for the same use give the same mesh.
bool reads_the_same(const MeshRequest& a, const MeshRequest& b);

/// Data that was put right, in counts over all meshes.
struct MeshRepairs {
  size_t normals_scaled = 0, normals_replaced = 0, tangents_dropped = 0, texcoords_zeroed = 0,
         texcoords_missing = 0;

  void add(const MeshRepairs& other);
  std::vector<Notice> notices() const;
};

/// Meshes as the last reading left them, for one in which they have the same shape.
class MeshCache {
 public:
  struct Entry {
    MeshRequest request;
    MeshDescription mesh;
    MeshRepairs repairs;
  };
  /// Null when the mesh was not asked for in the same way, or is moved by joints.
  std::shared_ptr<Entry> find(const MeshRequest& request) const;
  /// Takes the place of all there is.
  void replace(const std::vector<std::shared_ptr<Entry>>& entries);

 private:
  std::map<MeshUse, std::shared_ptr<Entry>> entries_;
};

/// Reads the meshes asked for, in parallel; points and lines have no body yet (thin_bodies.h).
/// `node_to_world` places the joints of skins. With a cache, copies what it has and leaves what it may need
/// next time. Throws Error(input) about the first mesh that cannot be used.
std::vector<MeshDescription> read_meshes(const Document& document, const std::vector<MeshRequest>& requests,
                                         const std::vector<Imath::M44d>& node_to_world, MeshRepairs& repairs,
                                         MeshCache* cache);

}  // namespace vernier
