// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "vernier/scene.h"

namespace vernier {

/// The point of a body that lies farthest in a direction: all that fitting a camera needs to know of it.
using FarthestPoint = std::function<Vec3f(const Vec3f& direction)>;

/// Moves a camera, without turning it, so that the body fills a picture of that width over height up to
/// `margin`, the part of the picture left free at either end of its tighter side; along the other side the
/// body is centred. Exact: what is fitted is the outline of the projected body, not a box or sphere about
/// it. The angle of a perspective camera is kept, the height of an orthographic one is set. margin is at
/// least 0 and less than 1/2.
CameraDescription fit_camera(CameraDescription camera, const FarthestPoint& farthest, float aspect,
                             float margin);

/// Turns `camera` so that it looks from `back` (unit) with `up` upward in its picture as far as may be.
void turn(CameraDescription& camera, const Vec3f& back, const Vec3f& up);
/// Turns it clockwise about its view, radians.
void roll(CameraDescription& camera, float angle);

class Subject;
/// A camera called "fitted" that is turned as the view says, and still to be put somewhere.
CameraDescription aimed_camera(const Subject& subject, const FittedView& view);
/// A camera called "fitted" that sees the subject whole.
CameraDescription fitted_camera(const Subject& subject, float aspect, const FittedView& view);

}  // namespace vernier
