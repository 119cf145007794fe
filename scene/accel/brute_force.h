// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "scene/accel/accelerator.h"

namespace vernier {

/// Tests every triangle: the truth that the trees are held against.
std::unique_ptr<Accelerator> build_brute_force(const Geometry& geometry);

}  // namespace vernier
