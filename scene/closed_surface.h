#pragma once

#include <span>

#include "scene/description.h"

namespace vernier {

/// Whether the triangles of these meshes together enclose something: each edge, vertices in exactly the same
/// place taken for one, is that of an even number of triangles. Triangles that are mere lines count for
/// nothing. Which way they are wound is not looked at, and vertices that lie within another triangle's edge
/// do not close it. Takes linear time and no memory, and errs with a chance of 2^-64 or so, towards "closed".
bool is_closed_surface(std::span<const MeshDescription* const> meshes);

}  // namespace vernier
