#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "core/image/image.h"

namespace vernier {

/// A rendered picture and the standard error of each of its values, three channels each.
struct MeasuredImage {
  const Image& mean;
  const Image& error;
  /// Degrees of freedom of each error: one less than the number of independent groups it was estimated from.
  double degrees = std::numeric_limits<double>::infinity();
};

/// Whether two noisy pictures have one expectation.
struct BiasTest {
  int64_t tested = 0;            ///< pixels
  int64_t not_finite = 0;        ///< pixels left out because a value or an error of theirs is NaN or infinite
  int64_t differing = 0;         ///< pixels found to differ; at most `level` of them, on average, wrongly
  double smallest_p = 1;         ///< of all pixels, before the allowance for their number
  int worst_x = 0, worst_y = 0;  ///< pixel of `smallest_p`
  std::array<double, 3> mean_difference{}, mean_error{};  ///< of the whole picture, with its standard error
  double mean_p = 1;                                      ///< that the whole picture's mean is the same
  double level = 0;

  bool different() const { return differing > 0 || mean_p < level; }
};

/// Two tests of the hypothesis that x and y estimate the same picture without bias. Pixel by pixel: Welch's
/// t-test of each channel (Welch 1947), the smallest of a pixel's three p-values after Sidak (1967), and over
/// the pixels the procedure of Benjamini and Hochberg (1995, "Controlling the False Discovery Rate"), which
/// keeps the expected part of false findings below `level`. And for the whole picture: the sum over pixels,
/// whose error is far smaller, so that a faint bias everywhere is found. Two unbiased pictures are called
/// different with probability at most 2 `level`, if their pixels are independent and their errors are right:
/// a pixel that has missed its rare bright paths in every group claims less error than it has. Differences of
/// less than two units in the last place of a float count as none. Throws Error(usage) when sizes differ.
BiasTest test_bias(const MeasuredImage& x, const MeasuredImage& y, double level = 0.01);

}  // namespace vernier
