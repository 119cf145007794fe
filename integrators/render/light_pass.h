// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "integrators/light_paths.h"
#include "integrators/render/render_state.h"

namespace vernier {

/// Light paths of a render, in batches that belong to its halves by turns. They are traced on all threads and
/// added to the film batch by batch, so that sums do not depend on the threads.
class LightPass {
 public:
  static constexpr uint64_t batch_size = 1024;  ///< light paths; a power of two, for stratification
  /// More than any render has.
  static constexpr uint64_t most_batches = uint64_t{1} << 52;

  /// Refers to things that live as long.
  LightPass(const LightPaths& paths, const LightSorter* sorter) : paths_(paths), sorter_(sorter) {}

  /// Batches when each pixel has so many camera samples. Of a picture of which a crop is rendered those of
  /// the whole, so that crops are as the whole is.
  uint64_t batches(uint32_t samples) const {
    const uint64_t paths = paths_.paths_per_sample() * samples;
    return (paths + Film::halves * batch_size - 1) / (Film::halves * batch_size) * Film::halves;
  }

  /// The next few batches, at most up to the number `end`.
  void advance(RenderState& state, uint64_t end) const;

  /// Tells the films of the light paths of batches [first, end).
  static void count_paths(RenderResult& result, uint64_t first, uint64_t end);

 private:
  void add(RenderState& state, const std::vector<Caught>& batches) const;

  const LightPaths& paths_;
  const LightSorter* sorter_;
};

}  // namespace vernier
