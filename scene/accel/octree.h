// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene/accel/accelerator.h"

namespace vernier {

/// An octree that lists each triangle in every leaf it touches: the other textbook structure, to compare
/// `bvh` with.
std::unique_ptr<Accelerator> build_octree(const Geometry& geometry);

}  // namespace vernier
