// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "integrators/render/comparison.h"

namespace vernier::apps {

/// Reads both files and measures. Throws Error(usage) when they cannot be compared.
Comparison compare_files(const std::string& picture, const std::string& reference,
                         const ComparisonOptions& options);

/// A limit as typed, METRIC>NUMBER or METRIC<NUMBER, that breaks when it holds.
class Limit {
 public:
  /// Throws Error(usage).
  explicit Limit(const std::string& text);

  /// What is wrong, empty when all is well. A figure that is not a number breaks it. Throws Error(usage) when
  /// the comparison has no such figure.
  std::string complaint(const Comparison& comparison) const;

 private:
  const Metric* metric_;
  bool above_;
  double bound_ = 0;
};

}  // namespace vernier::apps
