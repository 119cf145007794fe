// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/compare/bias_test.h"
#include "core/compare/flip.h"
#include "core/compare/metrics.h"
#include "vernier/image.h"

namespace vernier {

struct ComparisonOptions {
  bool flip = true;          ///< the costliest figure
  double bias_level = 0.01;  ///< expected part of false findings
  int bias_block = 8;        ///< pixels a side of the squares whose means are tested
};

/// What was measured of a picture x and its reference r.
struct Comparison {
  int width = 0, height = 0;
  bool linear = false;          ///< both hold linear light rather than display values
  double peak = 1;              ///< that psnr counts from: 1 for display values, else the largest value of r
  ImageDifference difference;   ///< over the pixels that show a surface, where a file tells
  std::optional<double> shown;  ///< part of the pixels that do
  std::optional<double> alpha;  ///< root mean square difference, over all pixels, when both files have it
  std::optional<FlipResult> flip;
  std::optional<BiasTest> bias;  ///< when both files have an error layer
  bool denoised = false;         ///< either picture: its error then includes what the filter did to it
};

/// A picture and what errors call it.
struct NamedPicture {
  std::string_view name;
  const LayeredImage& picture;
};

/// Throws Error(usage) when the two cannot be compared.
Comparison compare(const NamedPicture& picture, const NamedPicture& reference,
                   const ComparisonOptions& options);

/// A figure of a comparison that can be limited.
struct Metric {
  std::string_view name;
  std::string_view description;
  std::optional<double> (*value)(const Comparison&);
};

std::span<const Metric> metrics();

}  // namespace vernier
