// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "core/film/gradient_film.h"
#include "core/math/ray.h"

namespace vernier {

/// What a camera sample tells of the differences between its pixel and those beside, in the order of
/// PixelNeighbors.
struct GradientSample {
  std::array<Ray, PixelNeighbors::count> rays;       ///< the same sample of those pixels
  std::array<bool, PixelNeighbors::count> active{};  ///< which there are

  GradientFilm::Differences differences{Rgb(0.f), Rgb(0.f), Rgb(0.f), Rgb(0.f)};  ///< found
  Rgb primal_only{0, 0, 0};  ///< part of Estimate::radiance that they leave out

  bool is_finite() const {
    const auto finite = [](const Rgb& value) { return vernier::is_finite(value); };
    return finite(primal_only) && std::all_of(differences.begin(), differences.end(), finite);
  }
};

}  // namespace vernier
