// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <memory>

#include "apps/validation/soup.h"
#include "core/base/parallel.h"
#include "scene/accel/accelerator.h"

namespace vernier::validation {

/// How often something happened that must not.
struct Count {
  uint64_t events = 0, trials = 0;

  double per_million() const { return trials ? 1e6 * double(events) / double(trials) : 0; }
  Count& operator+=(const Count& other) {
    events += other.events;
    trials += other.trials;
    return *this;
  }
};

using BuildAccelerator = std::unique_ptr<Accelerator> (*)(const Geometry&);

/// Adds up count(rng, n), a Count of n trials, over portions of the trials with rng of their own, in
/// parallel: the same sum for any number of threads.
template <typename CountPortion>
Count count_portions(uint64_t trials, uint64_t portion, uint64_t seed, const CountPortion& count) {
  std::atomic<uint64_t> events = 0, made = 0;
  parallel_for((trials + portion - 1) / portion, [&](size_t stream) {
    Rng rng(seed, stream);
    const Count part = count(rng, std::min(portion, trials - stream * portion));
    events += part.events;
    made += part.trials;
  });
  return {events, made};
}

}  // namespace vernier::validation
