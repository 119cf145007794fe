// SPDX-License-Identifier: Apache-2.0
#include "scene/medium.h"

#include <algorithm>

namespace vernier {

FreeFlight::FreeFlight(const Medium& medium, const Rgb& carried, float length)
    : medium_(medium), share_(1.f / 3), length_(length) {
  const float all = carried.x + carried.y + carried.z;
  if (all > 0 && std::isfinite(all)) share_ = carried * (1 / all);
}

FreeFlight::Sample FreeFlight::sample(double u) const {
  int channel = 0;
  double below = 0;
  while (channel < 2 && u >= below + double(share_[channel])) below += double(share_[channel++]);
  const double within = share_[channel] > 0 ? (u - below) / double(share_[channel]) : 0;
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
