// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene/accel/accelerator.h"

namespace vernier {

/// Embree's BVH, single rays. Embree drops triangles with a coordinate beyond 1.8e18 (its FLT_LARGE).
std::unique_ptr<Accelerator> build_embree_fast(const Geometry& geometry);    ///< leaks at edges and vertices
std::unique_ptr<Accelerator> build_embree_robust(const Geometry& geometry);  ///< no leaks at edges

}  // namespace vernier
