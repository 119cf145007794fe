#pragma once

#include <vector>

#include "core/image/film.h"

namespace vernier {

/// How many samples each pixel and half gets in the next pass.
class SamplePlan {
 public:
  /// `count` more samples for every pixel, the halves alike.
  static SamplePlan uniform(const Film& film, uint32_t count);

  /// On average `count` more samples a pixel, more where they lower the image's relative error most. The
  /// number for one half depends on the samples of the other half only, so that neither half's mean is biased
  /// by its own luck (Kirk and Arvo 1991, "Unbiased Sampling Techniques for Image Synthesis"); docs/error.md
  /// has the measurement.
  static SamplePlan adaptive(const Film& film, uint32_t count);

  uint32_t count(int x, int y, int half) const {
    return counts_.empty() ? uniform_[half] : counts_[(size_t(y) * width_ + x) * Film::halves + half];
  }

 private:
  int width_ = 0;
  uint32_t uniform_[Film::halves] = {0, 0};
  std::vector<uint16_t> counts_;  ///< empty: uniform_ everywhere
};

}  // namespace vernier
