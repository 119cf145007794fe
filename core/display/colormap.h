// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/image.h"

namespace vernier {

/// Picture of a one-channel map: values from 0 to `largest` as display colours from black through purple and
/// orange to pale yellow, of evenly rising lightness; larger values are drawn as `largest`, NaN as green. The
/// colours are the map "magma" of Smith and van der Walt 2015 (matplotlib, CC0), interpolated between 17 of
/// its entries: within 3/255.
Image8 colormap(const Image& map, float largest = 1);

}  // namespace vernier
