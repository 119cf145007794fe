#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

namespace vernier {

/// How scene-linear values become display values.
struct DisplayOptions {
  std::string view;           ///< view name; empty: the config's default view of its default display
  std::string config;         ///< OpenColorIO config file; empty: $OCIO, else Vernier's built-in config
  float exposure = 0;         ///< stops: values are multiplied by 2^exposure first
};

/// Names of the views of the default display of that config, the default first.
std::vector<std::string> display_views(const DisplayOptions& options);

/// Scene-linear Rec.709 to 8-bit display values through OpenColorIO. Throws Error(usage) on an unknown view, listing
/// the ones there are, and Error(input) on an unusable config.
Image8 to_display(const Image& scene_linear, const DisplayOptions& options);

}  // namespace vernier
