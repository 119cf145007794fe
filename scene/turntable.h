// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/framing.h"
#include "scene/subject.h"

// Pictures from all around a subject, as of something that stands on a turntable.

namespace vernier {

/// All the room that a subject takes up while it turns once about the upright axis through the middle of its
/// bounds: a body of revolution.
class TurnedSubject {
 public:
  explicit TurnedSubject(const Subject& subject);

  const Vec3f& center() const { return center_; }
  Vec3f farthest(const Vec3f& direction) const;

 private:
  Vec3f center_;
  std::vector<Vec2d> profile_;  ///< convex hull of the corners' distances from the axis, and heights
};

/// As fitted_camera(), but from where the camera stands the subject stays in the picture whichever way it is
/// turned, and its axis in the middle.
CameraDescription fitted_turntable_camera(const Subject& subject, float aspect, const FittedView& view);

/// The camera carried around the upright axis through a point, toward +x as seen from +z: by a positive
/// angle, in radians, as azimuths grow.
CameraDescription carried_around(CameraDescription camera, const Vec3f& center, double angle);
/// The camera carried from one angle to another at constant speed while the shutter is open; in its middle it
/// is halfway.
CameraDescription carried_on(const CameraDescription& camera, const Vec3f& center, double from, double to);

}  // namespace vernier
