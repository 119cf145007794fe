// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/display/display.h"
#include "vernier/image.h"

namespace vernier::apps {

/// A picture as pages see it: of a render on its way, or a coarse one while there is no other yet.
struct Frame {
  uint64_t number = 0;  ///< grows with each
  uint64_t view = 0;    ///< that it is of
  int step = 1;         ///< pixels of the whole picture along the side of one of these
  Image color;  ///< scene-linear Rec.709; a fourth channel is alpha, by which the others are multiplied
  std::optional<Image> error;       ///< three channels: standard error of each value; none: not known
  std::string type;                 ///< of the file, "image/jpeg"
  std::vector<unsigned char> file;  ///< as displayed
};

/// Gives a frame its file: a JPEG, or a PNG where it has alpha.
void develop(Frame& frame, const DisplayOptions& display);

/// The relative standard errors of a frame as a map in colours, and what its palest stands for.
struct ErrorMap {
  std::vector<unsigned char> file;  ///< JPEG
  std::string largest;              ///< "20 %"
};
/// None while they are not known.
std::optional<ErrorMap> error_map(const Frame& frame);

/// Puts the coarse picture where `color` has no samples yet, as `covered` says by pixel.
void fill_gaps(Image& color, const Image& coarse, int step, const std::vector<bool>& covered);

}  // namespace vernier::apps
