// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "apps/validation/count.h"

// The hard cases of ray geometry as one table, each with the figure that tells how an accelerator does.

namespace vernier::validation {

struct Figure {
  double value = 0;
  std::optional<Count> count;  ///< that `value` is the rate of, per million

  Figure(double v) : value(v) {}
  Figure(const Count& c) : value(c.per_million()), count(c) {}
};

struct HardCase {
  std::string_view name;
  std::string_view figure;  ///< what is measured, in what unit; the less the better unless it says otherwise
  Figure (*measure)(const AcceleratorEntry&, uint64_t rays);
  uint64_t most_rays = ~uint64_t{0};  ///< more tell nothing new, or take too long
};

std::span<const HardCase> hard_cases();

}  // namespace vernier::validation
