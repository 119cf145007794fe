// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/gradient_sample.h"
#include "integrators/integrator.h"
#include "integrators/render/camera_sample.h"

// What a render does for integrators that estimate differences between pixels.

namespace vernier {

/// Throws Error(usage) for what they cannot render; for others nothing.
void check_gradients(const Integrator& integrator, const Scene& scene, const RenderSettings& settings);

/// A camera sample as the pixels beside have it, as far as they lie in this part of the picture.
GradientSample neighbors_of(const CameraSampleId& id, const CameraSamples& samples, const Crop& part);

}  // namespace vernier
