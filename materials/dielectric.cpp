// SPDX-License-Identifier: Apache-2.0
#include "materials/dielectric.h"

#include <map>
#include <mutex>

namespace vernier {

const Dispersion& Dispersion::of(const std::array<float, 3>& eta) {
  static std::mutex mutex;
  static std::map<std::array<float, 3>, Dispersion> dispersions;
  const std::lock_guard lock(mutex);
  const auto [entry, is_new] = dispersions.try_emplace(eta);
  if (is_new) {
    entry->second.eta = eta;
    for (size_t c = 0; c < 3; ++c) entry->second.energy[c] = &DielectricAlbedo::of(eta[c]);
  }
  return entry->second;
}

}  // namespace vernier
