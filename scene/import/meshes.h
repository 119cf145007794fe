#pragma once

#include <array>
#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// One mesh primitive as some node uses it.
struct MeshRequest {
  int mesh = 0, primitive = 0;
  std::array<bool, 2> texcoords{};  ///< TEXCOORD_n that the material reads
  bool tangents = false;            ///< the material reads tangents
};

/// Data that was put right, in counts over all meshes.
struct MeshRepairs {
  size_t normals_scaled = 0, normals_replaced = 0, tangents_dropped = 0, texcoords_zeroed = 0,
         texcoords_missing = 0;

  void add(const MeshRepairs& other);
  std::vector<Notice> notices() const;
};

/// Reads the meshes asked for, in parallel. Throws Error(input) about the first of them that cannot be used.
std::vector<MeshDescription> read_meshes(const Document& document, const std::vector<MeshRequest>& requests,
                                         MeshRepairs& repairs);

}  // namespace vernier
