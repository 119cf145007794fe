// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "vernier/image.h"

namespace vernier {

/// A rendered picture and the standard error of each of its values, three channels each.
struct MeasuredImage {
  const Image& mean;
  const Image& error;
  /// Degrees of freedom of each error: how many independent numbers it was estimated from, less the means.
  double degrees = std::numeric_limits<double>::infinity();
  /// One channel, not 0 where the error is not to be trusted; null: it is everywhere.
  const Image* unreliable = nullptr;
  /// Whether neighbors err together, as in a picture that was filtered: their errors add up, not the squares
  /// of them.
  bool errs_together = false;
};

/// Whether two noisy pictures have one expectation.
struct BiasTest {
  int block = 1;                 ///< the pictures are tested in squares of so many pixels a side
  int64_t tested = 0;            ///< blocks
  int64_t not_finite = 0;        ///< pixels left out because a value or an error of theirs is NaN or infinite
  int64_t unreliable = 0;        ///< pixels left out of their blocks because an error is not to be trusted
  int64_t differing = 0;         ///< blocks found to differ; at most `level` of them, on average, wrongly
  double smallest_p = 1;         ///< of all blocks, before the allowance for their number
  int worst_x = 0, worst_y = 0;  ///< first pixel of the block of `smallest_p`
  std::array<double, 3> mean_difference{}, mean_error{};  ///< of the whole picture, with its standard error
  double mean_p = 1;                                      ///< that the whole picture's mean is the same
  double level = 0;

  bool different() const { return differing > 0 || mean_p < level; }
};

/// Two tests of the hypothesis that x and y estimate the same picture without bias. Block by block: Welch's
/// t-test of the block's sum in each channel (Welch 1947), the smallest of its three p-values after Sidak
/// (1967), and over the blocks the procedure of Benjamini and Hochberg (1995, "Controlling the False
/// Discovery Rate"), which keeps the expected part of false findings below `level`. And for the whole
/// picture: the sum over all its pixels, whose error is far smaller, so that a faint bias everywhere is
/// found. Two unbiased pictures are called different with probability at most 2 `level`, if their pixels are
/// independent and their errors are right. Errors that are right only on average over neighbouring pixels, as
/// a render's are, ask for blocks of several pixels. Pixels whose errors are not to be trusted are left out
/// of the first test; the second has them. Differences of less than two units in the last place of a float
/// count as none. Throws Error(usage) when sizes differ.
BiasTest test_bias(const MeasuredImage& x, const MeasuredImage& y, double level = 0.01, int block = 1);

}  // namespace vernier
