// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "vernier/scene.h"

namespace vernier {

/// Makes vertex sources[i] the mesh's i-th vertex, in every attribute there is. Triangles are the caller's to
/// renumber.
void gather_vertices(MeshDescription& mesh, const std::vector<uint32_t>& sources);

/// Gives each triangle vertices of its own.
void unshare_vertices(MeshDescription& mesh);

/// Drops the vertices that no triangle uses, when there must be some by their number alone: files may share
/// one set of vertices among many primitives.
void drop_unused_vertices(MeshDescription& mesh);

}  // namespace vernier
