// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/tables/ggx_energy.h"

namespace vernier {

/// ggx_albedo() of a lobe whose widths differ: within 5e-3, but across the wide axis of a lobe of full width
/// within 1e-2 at a ratio of 20 and 4e-2 at 100. From tables of pairs of widths, each integrated when first
/// asked for in some 10 ms on one core; a lookup reads four of them. May be called from any thread.
GgxAlbedo anisotropic_albedo(const Vec3f& w, const Ggx& ggx);

/// Its cosine-weighted mean over the hemisphere.
GgxAlbedo anisotropic_average_albedo(const Ggx& ggx);

}  // namespace vernier
