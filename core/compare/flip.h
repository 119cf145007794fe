// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/image.h"

namespace vernier {

/// A perceived difference of two pictures as one flips between them.
struct FlipResult {
  Image map;        ///< one channel in [0, 1] a pixel: 0 no difference seen, 1 the largest
  double mean = 0;  ///< of the map
  // HDR only: stops of the darkest and the brightest exposure tried, and how many there were.
  double start_exposure = 0, stop_exposure = 0;
  int exposures = 1;
};

/// Pixels a degree of visual angle for a 0.7 m wide monitor of 3840 pixels seen from 0.7 m.
inline constexpr float flip_pixels_per_degree = 67.0206432f;

/// LDR-FLIP of display pictures, three channels of sRGB values in [0, 1] (values outside are clamped, NaN
/// counts as 0) (Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference
/// Evaluator for Alternating Images", Proc. ACM CGIT 3(2)). Throws Error(usage) when sizes differ.
FlipResult flip(const Image& x, const Image& reference, float pixels_per_degree = flip_pixels_per_degree);

/// HDR-FLIP of scene-linear Rec.709: the largest LDR-FLIP over exposures that the reference's median and
/// largest luminance set, through the ACES approximation of Narkowicz 2016 (Andersson, Nilsson, Shirley,
/// Akenine-Moeller 2021, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics short
/// papers). Negative values and NaN count as 0.
FlipResult hdr_flip(const Image& x, const Image& reference, float pixels_per_degree = flip_pixels_per_degree);

}  // namespace vernier
