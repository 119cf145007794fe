// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vernier/image.h"

namespace vernier {

/// How scene-linear values become display values.
///
/// The built-in config has one display, sRGB, with the views
/// - "ACES SDR" (default): ACES 1.x output transform for 100-nit video, by OpenColorIO's built-in transform;
/// - "standard": the sRGB transfer function, values above 1 clipped, no tone mapping;
/// - "neutral": the Khronos PBR Neutral tone mapper, for faithful product colour, then as standard;
/// - "raw": the values themselves.
/// In a config of the user's, linear Rec.709 is the colour space of one of its customary names ("Linear
/// Rec.709 (sRGB)", "Utility - Linear - sRGB", ...), else reached through the role aces_interchange, else
/// taken to be the role scene_linear. Values that are not numbers become 0 and others are limited to +-65504,
/// after exposure.
struct DisplayOptions {
  std::string view = {};    ///< view name; empty: the config's default view of its default display
  std::string config = {};  ///< OpenColorIO config file; empty: $OCIO, else Vernier's built-in config
  float exposure = 0;       ///< stops: values are multiplied by 2^exposure first
};

/// Names of the views of the default display of that config, the default first.
std::vector<std::string> display_views(const DisplayOptions& options);

/// Scene-linear Rec.709 to 8-bit display values through OpenColorIO. A fourth channel is alpha, by which the
/// other three are multiplied (associated); in the result they are not, as PNG has it (ISO/IEC 15948, 6.2).
/// Throws Error(usage) on an unknown view, listing the ones there are, and Error(input) on an unusable
/// config.
Image8 to_display(const Image& scene_linear, const DisplayOptions& options);

}  // namespace vernier
