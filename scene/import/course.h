// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "vernier/math.h"
#include "vernier/scene.h"

namespace vernier {

/// The way of some points while the shutter is open, sampled at 2^n + 1 moments for growing n, and at how
/// many of them it must be known for what is linear in between to follow it.
class Course {
 public:
  static constexpr int finest = 5;  ///< n of most_moments
  static_assert((1u << finest) + 1 == most_moments);

  /// Of the moments of level n every 2^(finest - n)th is one.
  static constexpr size_t stride(int level) { return size_t(1) << (finest - level); }

  bool has(size_t moment) const { return !points_[moment].empty(); }
  void set(size_t moment, std::vector<Vec3d> points) { points_[moment] = std::move(points); }

  /// Whether any point is ever farther from where it is at the opening than `distance` and than the rounding
  /// of its coordinates to float explains.
  bool moves(double distance) const;
  /// The least level whose chords are within `tolerance` of all samples, which are those of level `sampled`;
  /// none when samples between those of the last level must tell.
  std::optional<int> level(int sampled, double tolerance) const;

 private:
  bool fits(int level, int sampled, double tolerance) const;

  std::array<std::vector<Vec3d>, most_moments> points_;
};

}  // namespace vernier
