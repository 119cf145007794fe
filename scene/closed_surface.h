// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "vernier/math.h"

namespace vernier {

/// Tells whether triangles close off a region of space, and which way they face. Nothing is asked of shared
/// vertices: fields without divergence flow out of a closed surface as much as into it, whatever it is made
/// of, and out of an open one by as much as its hole lets through (Gauss). Seams that do not match and holes
/// below a thousandth of the area do not count.
class ClosedSurfaceTest {
 public:
  /// Around the center of what is to be tested, in the scale of its size.
  ClosedSurfaceTest(const Vec3f& lower, const Vec3f& upper);

  /// Counter-clockwise seen from the front.
  void add(const Vec3f& a, const Vec3f& b, const Vec3f& c);

  bool is_closed() const;
  /// Its fronts look to the inside.
  bool is_inward() const { return volume_ < 0; }

 private:
  static constexpr size_t fields = 8, degrees = 4;

  Vec3d center_, scale_;
  double area_ = 0, volume_ = 0;
  std::array<std::array<double, degrees>, fields> flux_{};
};

}  // namespace vernier
