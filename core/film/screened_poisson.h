// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "vernier/image.h"

namespace vernier {

/// Differences between neighboring pixels, each over the pixel that it begins at: `right` of that to its
/// right less itself, `down` of that below. Those that would lead out of the picture are not looked at.
struct PixelDifferences {
  Image right, down;
};

/// What to add to a picture so that its own differences fit better to wanted ones: the c that makes the sum
/// over pixels of screen c^2 and over neighbors of (difference of c - lack)^2 least (the screened Poisson
/// equation of Bhat et al. 2008, "Fourier Analysis of the 2D Screened Poisson Equation for Gradient Domain
/// Problems"). `lack` holds the wanted differences less those of the picture; `screen` > 0 is how much the
/// picture's own values count beside them.
///
/// Chebyshev's semi-iteration of a fixed number of steps (Golub and Varga 1961): a fixed linear function of
/// `lack`, so that means of pictures are means of what is made of them, without sums over the picture, so
/// that the values do not depend on threads.
Image solve_screened_poisson(const PixelDifferences& lack, float screen);

/// Memory that it takes, `lack` and the result included.
constexpr size_t screened_poisson_bytes_per_pixel() { return 5 * 3 * sizeof(float); }

}  // namespace vernier
