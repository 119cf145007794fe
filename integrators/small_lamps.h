// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier {

/// Emissive triangles that a camera sees smaller than a pixel. Few camera samples meet one, and what these
/// find is most of the picture's noise; so what the camera sees of them straight is left out of its samples
/// and brought by light paths of one vertex, from a point of the lamp to the lens (Veach 1997, section 10.2,
/// the technique s = 1, t = 1). What mirrors and panes show of them remains with camera samples.
class SmallLamps {
 public:
  /// None.
  SmallLamps() = default;
  /// Those of a picture of width x height pixels. A triangle is one if it is brighter than a dark surface and
  /// its surroundings in the picture are not full of such triangles, as they are where a mesh glows all over.
  SmallLamps(const Scene& scene, const Camera& camera, int width, int height);

  size_t size() const { return lamps_.size(); }
  bool contains(const SurfacePoint& at) const {
    return !of_instance_.empty() && !of_instance_[at.instance].empty() &&
           of_instance_[at.instance][at.primitive];
  }

  /// Light paths that pay for every camera sample of all pixels.
  uint64_t paths_per_sample() const;

  /// A point on one of them, and the area of its surface over the probability of choosing this lamp, in
  /// square metres: the inverse of the point's density.
  struct Sample {
    SurfacePoint at;
    float area;
  };
  /// Both numbers evenly distributed in [0, 1). Of at least one lamp.
  Sample sample(double choice, const Vec2f& place) const;

 private:
  struct Lamp {
    TriangleId triangle;
    float area;  ///< square metres
  };
  const SceneGeometry* geometry_ = nullptr;
  std::vector<Lamp> lamps_;
  std::vector<std::vector<bool>> of_instance_;  ///< by instance and triangle; empty: none
};

}  // namespace vernier
