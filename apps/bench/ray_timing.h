// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "apps/bench/path_rays.h"
#include "scene/accel/accelerator.h"

// Several accelerators timed on the same rays, in turns, so that what else the machine does strikes all
// alike.

namespace vernier::apps {

struct RayKind {
  std::string_view name;
  std::vector<Ray> PathRays::*rays;
  bool occlusion;  ///< asked with occluded(), else with closest()
};
constexpr std::array<RayKind, 3> ray_kinds{{{"primary", &PathRays::primary, false},
                                            {"bounce", &PathRays::bounce, false},
                                            {"shadow", &PathRays::shadow, true}}};

/// One accelerator of the comparison.
struct TimedAccelerator {
  explicit TimedAccelerator(const AcceleratorEntry& e) : entry(&e) {}

  const AcceleratorEntry* entry;
  std::unique_ptr<Accelerator> accelerator;
  std::vector<double> build_seconds;  ///< by repetition
  size_t stride = 1;  ///< only every stride-th ray is traced; more than 1 for those that take too long
  struct Cost {
    double nodes, blocks;  ///< a ray
  };
  std::array<std::optional<Cost>, ray_kinds.size()> cost;
  /// Seconds that all rays of a kind take, by repetition; index 0: processor time of one thread, 1:
  /// wall-clock time on all.
  std::array<std::array<std::vector<double>, ray_kinds.size()>, 2> seconds;

  /// Of all kinds together.
  std::vector<double> mixed_seconds(size_t threads) const;
};

/// Rays among 10^6 that the two answer differently: another triangle, or blocked and not. At seams between
/// triangles either of them may be right.
double differing_per_million(const TimedAccelerator& a, const TimedAccelerator& b, const RayKind& kind,
                             std::span<const Ray> rays);

/// Builds and times them.
void time_accelerators(std::vector<TimedAccelerator>& candidates, const Geometry& geometry,
                       const PathRays& rays, int repetitions);

}  // namespace vernier::apps
