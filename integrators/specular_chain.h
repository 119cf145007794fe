// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "scene/segment.h"

namespace vernier {

/// Two unit vectors that with a third form a right-handed frame.
struct Tangents {
  explicit Tangents(const Vec3d& normal);
  Vec3d x, y;
};

/// A ray, and how it moves as the direction that its chain began with is turned about its tangents, per
/// radian (Igehy 1999, "Tracing Ray Differentials", section 3). In double, for what is looked for is where
/// rays end that many surfaces have bent.
struct Pencil {
  Vec3d origin, direction;  ///< the direction is a unit vector, in the derivatives too
  std::array<Vec3d, 2> d_origin, d_direction;
};

/// What happens at the surfaces of a chain, in order.
class ChainEvents {
 public:
  static constexpr int most = 32;  ///< more are not added

  void add(bool is_transmitted) {
    if (size_ < most) transmitted_ |= uint32_t(is_transmitted) << size_++;
  }
  int size() const { return size_; }
  bool is_full() const { return size_ == most; }
  bool is_transmitted(int i) const { return (transmitted_ >> i & 1) != 0; }
  bool operator==(const ChainEvents&) const = default;

 private:
  uint32_t transmitted_ = 0;
  int size_ = 0;
};

/// A path that goes from a point by surfaces that reflect or refract it sharply, by the shading normals that
/// their BSDFs have. Surfaces with normal textures end it, since nothing tells how these bend.
class SpecularChain {
 public:
  /// Leaves `from` in the unit direction, with light of the channels of `throughput`.
  SpecularChain(const Scene& scene, const Interaction& from, const Vec3d& direction, const Rgb& throughput);

  /// Looks for the next surface. Whether it has sharp lobes, by which the chain can go on.
  bool meet();
  /// What meet() has found there.
  const DeltaLobes& lobes() const { return lobes_; }
  /// Goes on by one of these lobes. False: it carries nothing, and the chain is at its end.
  bool turn(bool is_transmitted);

  /// The last turn was none: light passes the surface undeflected.
  bool is_straight() const { return is_straight_; }
  /// Where the last turn was.
  const Interaction& at() const { return at_; }
  /// How the chain leaves it.
  const Pencil& pencil() const { return pencil_; }
  /// Through what.
  const MediumStack& media() const { return segment_.media; }
  /// What gets from beyond the last turn to where the chain began.
  const Rgb& weight() const { return weight_; }

 private:
  struct Sheet;
  std::optional<Sheet> sheet() const;
  void bend(const Sheet& sheet, bool is_transmitted);

  const Scene& scene_;
  Segment segment_;
  Interaction at_;
  std::optional<Interaction> next_;
  DeltaLobes lobes_;
  Pencil pencil_;
  Rgb throughput_, weight_{1, 1, 1};
  bool is_straight_ = false;
};

}  // namespace vernier
