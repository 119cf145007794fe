// SPDX-License-Identifier: Apache-2.0
#include "core/denoise/denoise_filters.h"

namespace vernier {

// Buades, Coll and Morel 2005, "A Non-Local Algorithm for Image Denoising", with the distances that
// Rousselle, Knaus and Zwicker 2012 ("Adaptive Rendering with Non-Local Means Filtering") measure against the
// noise.
Image denoise_nlm(const NoisyImage& noisy) {
  const GuidedImage guided = prepare(noisy);
  return modulate(weighted_average(guided, {.radius = 10, .color_distance = 0.7f, .patch_radius = 3}),
                  guided);
}

}  // namespace vernier
