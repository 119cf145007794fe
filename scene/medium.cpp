// SPDX-License-Identifier: Apache-2.0
#include "scene/medium.h"

#include <algorithm>

namespace vernier {

FreeFlight::FreeFlight(const Medium& medium, const Rgb& throughput, float length)
    : medium_(medium), share_(1.f / 3), length_(length) {
  const float all = throughput.x + throughput.y + throughput.z;
  // Of next to nothing no quotients can be told.
  if (all > std::numeric_limits<float>::min() && std::isfinite(all)) share_ = throughput / all;
}

FreeFlight::Sample FreeFlight::sample(double u) const {
  // The last of those that have a share also gets what rounding leaves of 1.
  int channel = share_.z > 0 ? 2 : share_.y > 0 ? 1 : 0;
  double below = 1 - double(share_[channel]);
  const double x = double(share_.x), y = double(share_.y);
  if (u < x) {
    channel = 0;
    below = 0;
  } else if (channel == 2 && u < x + y) {
    channel = 1;
    below = x;
  }
  const double within = (u - below) / double(share_[channel]);
  const float extinction = medium_.extinction[channel];
  const float distance =
      extinction > 0 ? float(-std::log1p(-std::clamp(within, 0., 0x1.fffffffffffffp-1)) / double(extinction))
                     : std::numeric_limits<float>::infinity();
  if (distance < length_) return {distance, scattered(distance) / pdf(distance), true};
  const Rgb left = transmittance(medium_, length_);
  const float prob = dot(share_, left);
  return {distance, prob > 0 ? left / prob : Rgb(0, 0, 0), false};
}

float FreeFlight::pdf(float distance) const {
  return dot(share_, medium_.extinction * transmittance(medium_, distance));
}

}  // namespace vernier
