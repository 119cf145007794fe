// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace vernier::apps {

/// What a render of one picture is made of, as far as memory goes.
struct MemoryUse {
  bool adaptive = true;
  bool alpha = false;
  bool background_picture = false;
  int layer_channels = 0;     ///< beside the color's three, and alpha
  size_t light_parts = 0;     ///< kept apart while rendering
  bool error_layers = false;  ///< whether some layer needs error_layers()
  bool denoise = false;
  bool display = false;  ///< whether a .png or .jpg is written
  bool report = false;
  bool splats = false;     ///< whether light paths may bring light, of which scene and camera decide
  bool gradients = false;  ///< whether the integrator tells of differences between pixels
  bool half = false;       ///< whether an .exr has 16-bit values, which are limited in a copy
};

/// Bytes that a pixel takes at the peak: while rendering or while the outputs are made, whichever needs more.
/// The scene comes on top.
size_t peak_bytes_per_pixel(const MemoryUse& use);

}  // namespace vernier::apps
