// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "materials/ggx.h"
#include "materials/tables/ggx_energy.h"

namespace vernier {

/// Light that a GGX lobe of reflectance 1 returns toward wo after one bounce, by quadrature in some 10
/// microseconds: what is missing, within 1e-4, and as `schlick_bias` the mean grazing reflectance of its
/// facets in excess of a smooth surface's share, which bends little and so is what tables keep.
GgxAlbedo integrate_ggx_albedo(const Vec3f& wo, const Ggx& ggx);

}  // namespace vernier
