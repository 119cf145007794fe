// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathMatrix.h>

#include <optional>
#include <vector>

#include "scene/geometry.h"

namespace vernier {

/// Sums over triangles, weighted by area: of n n^T, whose largest eigenvector is the normal of something
/// flat, and of n.
struct NormalSums {
  Imath::M33d tensor{0, 0, 0, 0, 0, 0, 0, 0, 0};
  Vec3d normal{0, 0, 0};

  void add(const NormalSums& other) {
    tensor += other.tensor;
    normal += other.normal;
  }
};

/// What a picture of a scene is of: its instances but for their setting and for strays, in a view of which
/// they would be lost. Setting is what is flat (the ground, a backdrop) or seen from inside (the dome of a
/// sky), and ten times as large as the subject. Strays, such as a triangle that a program forgot, are too
/// small for a view of all, which would show the others twenty times as small as they can be seen. What a
/// transform makes a point of, as programs hide things, is not there.
class Subject {
 public:
  /// The geometry must live as long.
  explicit Subject(const SceneGeometry& geometry);

  bool empty() const { return parts_.empty(); }
  /// Instances that were left out as setting, and as strays.
  size_t left_out() const { return left_out_; }
  size_t strays() const { return strays_; }
  /// Of the triangles' corners, in the world.
  const Bounds& bounds() const { return bounds_; }
  /// The same; some place about the origin when there is nothing to see.
  Bounds bounds_to_see() const;
  /// The corner of a triangle that lies farthest in a direction. The subject must not be empty.
  Vec3f farthest(const Vec3f& direction) const;
  /// Calls visit(p) for every corner of a triangle, in the world and in no stated order.
  template <typename Visit>
  void for_each_corner(const Visit& visit) const {
    for (const Part& part : parts_)
      for (uint32_t i = 0; i < geometry_.triangle_count(part.instance); ++i)
        for (const Vec3f& p : geometry_.triangle(part.instance, i))
          if (is_finite(p)) visit(p);
  }
  /// Unit normal of a subject that is as good as flat, a card: on the side of its fronts, or toward `viewer`
  /// where it has as many on both.
  std::optional<Vec3f> flat_normal(const Vec3f& viewer) const;

 private:
  struct Part {
    uint32_t instance;
    Bounds bounds;
  };

  void leave_out_setting();
  void leave_out_strays();
  NormalSums normal_sums() const;

  const SceneGeometry& geometry_;
  std::vector<Part> parts_;
  size_t left_out_ = 0, strays_ = 0;
  Bounds bounds_;
};

}  // namespace vernier
