// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <mutex>

#include "apps/validation/excuse.h"
#include "scene/geometry.h"

namespace vernier::validation {

/// A ray that two accelerators answered differently.
struct Difference {
  Ray ray;
  bool is_occlusion = false;          ///< whether the query was occluded()
  std::optional<RawHit> mine, other;  ///< what each met first
};

/// What two accelerators said of the same rays.
struct CrossCheckResult {
  uint64_t rays = 0;
  uint64_t at_boundary = 0, at_end = 0, tied = 0;  ///< differences that rounding excuses
  uint64_t leaks = 0;                ///< of those at boundaries: one met nothing where the other did
  uint64_t real = 0;                 ///< differences without excuse
  std::vector<Difference> examples;  ///< the first few of the real ones that came up
};

/// Answers queries as one accelerator and asks another the same. What a renderer does with it are the rays of
/// real paths.
class CrossCheck : public Accelerator {
 public:
  /// `mine` answers. The two that are compared, `a` and `b`, are built from the same geometry without its
  /// filter, since how far along a triangle a hit lies may decide what a filter says. `geometry` must live as
  /// long.
  CrossCheck(const SceneGeometry& geometry, std::unique_ptr<Accelerator> mine, std::unique_ptr<Accelerator> a,
             std::unique_ptr<Accelerator> b)
      : geometry_(geometry), mine_(std::move(mine)), a_(std::move(a)), b_(std::move(b)) {}

  std::optional<RawHit> closest(const Ray& ray) const override;
  bool occluded(const Ray& ray) const override;
  bool occluded(const Ray& ray, std::vector<RawHit>& passed) const override;
  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override;
  AcceleratorStats stats() const override { return mine_->stats(); }

  uint64_t rays() const { return rays_; }
  CrossCheckResult result() const;

 private:
  void check_closest(const Ray& ray) const;
  void check_occluded(const Ray& ray) const;
  void judge(const Difference& difference) const;

  const SceneGeometry& geometry_;
  const std::unique_ptr<Accelerator> mine_, a_, b_;
  mutable std::atomic<uint64_t> rays_ = 0;
  mutable std::mutex mutex_;
  mutable CrossCheckResult found_;  ///< but for the number of rays
};

}  // namespace vernier::validation
