// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/denoise_filters.h"

namespace vernier {

Image denoise_gaussian(const NoisyImage& noisy) {
  const GuidedImage guided = prepare(noisy);
  return modulate(keep_unexplained(weighted_average(guided, {.radius = 6, .deviation = 2}), guided), guided);
}

}  // namespace vernier
