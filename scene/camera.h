// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathQuat.h>

#include <optional>
#include <vector>

#include "core/math/ray.h"
#include "core/math/ray_cone.h"
#include "vernier/scene.h"

namespace vernier {

/// A camera for a picture of width x height pixels. Raster x runs right, y down, (0,0) the outer corner of
/// the first pixel; positions outside of the picture are as good as those in it. The vertical extent is the
/// description's; the horizontal follows the picture's shape (square pixels). A panorama is stretched to it.
/// Where no time is given, it stands where it does in the middle of the shutter.
class Camera {
 public:
  Camera(const CameraDescription& description, int width, int height);

  /// World ray through raster position `raster`, unit direction; with a lens, through its centre.
  Ray ray(const Vec2f& raster) const;

  bool has_lens() const { return lens_radius_ > 0; }
  /// The ray that goes through this point of the opening, which is the unit disk. All that belong to one
  /// raster position meet in the plane that is in focus: a thin lens (Cook, Porter and Carpenter 1984,
  /// "Distributed Ray Tracing") whose angle of view does not change with its focus.
  Ray ray(const Vec2f& raster, const Vec2f& on_lens) const;

  bool moves() const { return !moments_.empty(); }
  /// The same rays at a time of the shutter; without a point of the lens, through its centre.
  Ray ray(const Vec2f& raster, const std::optional<Vec2f>& on_lens, float time) const;
  /// Of the rays through a square of one pixel about a raster position, the lens left out of account.
  RayCone pixel_cone(const Vec2f& raster) const;
  /// How a point of the world is seen.
  struct Sight {
    Vec3f origin;  ///< of the ray to it
    Vec2f raster;
    /// Of the picture, in pixels, over that of a surface at the point that faces the ray, in square metres.
    float area;
  };
  /// At a time of the shutter from a point of the opening, which is the unit disk; empty when it is not in
  /// front of the camera.
  std::optional<Sight> sight(const Vec3f& world, const Vec2f& on_lens, float time) const;

  /// Raster position of a world point, seen from the lens's centre; empty when it is not in front of the
  /// camera.
  std::optional<Vec2f> project(const Vec3f& world) const;

  /// Its picture goes on beyond its edges, at the other side.
  bool is_panorama() const { return kind_ == CameraDescription::Kind::panorama; }

  /// Metres along the axis to what `ray`, one of this camera's from the lens's centre, meets at `t`; for a
  /// panorama, which has no axis, along the ray.
  float depth(const Ray& ray, float t) const;

 private:
  /// Where it is, and its axes: orthonormal, world.
  struct Place {
    Vec3f origin, right, up, back;
  };
  /// The same between moments; of q and -q the one nearer to the moment before.
  struct Moment {
    Vec3f origin;
    Imath::Quatf rotation;
  };

  std::optional<Sight> sight(const Place& place, const Vec3f& world, const Vec2f& on_lens) const;
  static Place place_of(const Transform& to_world);
  Place place_at(float time) const;
  Vec2f on_image_plane(const Vec2f& raster) const;
  Ray ray(const Place& place, const Vec2f& raster) const;
  Ray ray(const Place& place, const Vec2f& raster, const Vec2f& on_lens) const;

  CameraDescription::Kind kind_;
  Place place_;                  ///< in the middle of the shutter
  std::vector<Moment> moments_;  ///< empty: it stands still
  Vec2f half_extent_;            ///< of the image plane: at unit distance, or in metres for orthographic
  float width_, height_;
  float lens_radius_, inverse_focus_;  ///< metres, one over metres
};

}  // namespace vernier
