// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/denoise_filters.h"

namespace vernier {

// Tomasi and Manduchi 1998, "Bilateral Filtering for Gray and Color Images", with colours compared in units
// of their noise, and as a joint filter (Eisemann and Durand 2004; Petschnigg et al. 2004) where there are
// guides.
Image denoise_bilateral(const NoisyImage& noisy) {
  const GuidedImage guided = prepare(noisy);
  return modulate(weighted_average(guided, {.radius = 6, .deviation = 2, .color_distance = 2.5f}), guided);
}

}  // namespace vernier
