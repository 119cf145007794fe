// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "scene/medium.h"
#include "scene/scene.h"

// Light between two points: what a ray travels through, what it meets, and how much of the light gets along.

namespace vernier {

/// Triangles of volumes that lie, to rounding, where a ray begins: it has crossed them already.
class CrossedTriangles {
 public:
  CrossedTriangles() = default;
  /// Only what is there is copied: at most points that is nothing.
  CrossedTriangles(const CrossedTriangles& other) { *this = other; }
  CrossedTriangles& operator=(const CrossedTriangles& other) {
    size_ = other.size_;
    if (size_ > 0) ids_ = other.ids_;
    return *this;
  }

  void add(const TriangleId& triangle) {
    if (size_ < ids_.size()) ids_[size_++] = {triangle.instance, triangle.primitive};
  }
  bool contains(const TriangleId& triangle) const {
    for (uint32_t i = 0; i < size_; ++i)
      if (ids_[i][0] == triangle.instance && ids_[i][1] == triangle.primitive) return true;
    return false;
  }

 private:
  uint32_t size_ = 0;
  std::array<std::array<uint32_t, 2>, 4> ids_;  ///< instance and primitive
};

/// A ray, and what it travels through from its origin on.
struct Segment {
  Ray ray;
  MediumStack media{};
  CrossedTriangles crossed{};
};

/// A surface that a segment meets, and the media on both sides of it.
struct Interaction : SurfacePoint {
  MediumStack before, beyond;  ///< on the side that the segment came from, on the other
  CrossedTriangles crossed;

  /// The media into which a ray leaves along w (world).
  const MediumStack& toward(const Vec3f& w) const { return (dot(w, ng) > 0) == front ? before : beyond; }
  /// What leaves the surface along w (world, any length).
  Segment spawn(const Vec3f& w) const { return {SurfacePoint::spawn(w), toward(w), crossed}; }
  /// The same to a light.
  Segment spawn_to(const LightSample& light) const { return {light.shadow, toward(light.wi), crossed}; }
};

/// What a camera sees along a ray, with the media at its origin.
Segment camera_segment(const Scene& scene, const Ray& ray);

/// The first surface along a segment that light notices. Boundaries of volumes within a volume of higher
/// priority are none. Where several surfaces coincide to rounding, they are one: an opaque one if there is
/// any, else the boundary between what lies before and beyond them all.
std::optional<Interaction> intersect(const Scene& scene, const Segment& segment);
/// The same for segments from the camera, to which the backs of single-sided materials do not exist
/// (glTF 2.0, 3.9.6); all others meet both sides, because light does.
std::optional<Interaction> intersect_from_camera(const Scene& scene, const Segment& segment);

/// What gets along a segment.
struct Passage {
  /// Fraction of light: 0 if anything stands between the ends that does not let it pass straight on.
  Rgb fraction{0, 0, 0};
  int surfaces = 0;  ///< passed
  /// Light gets through, but bent, on other ways than this: `fraction` is what would pass if it went
  /// straight, along narrow lobes only.
  bool is_bent = false;
  bool is_sharp = true;         ///< what bends it does so by sharp lobes alone
  bool has_normal_map = false;  ///< of which some follow a normal texture
};

/// The one answer to how much light gets along a segment, its ends excluded: opaque surfaces, coverage, clear
/// surfaces that do not bend, and absorption over its length, which may be infinite.
Passage transmittance(const Scene& scene, const Segment& segment);

/// The one color channel that a path still carries, if only one.
std::optional<int> single_live_channel(const Rgb& throughput);

/// The scattering at an interaction toward the unit direction wo, for a path whose throughput is
/// `throughput`.
Shading shade(const Scene& scene, const Interaction& at, const Vec3f& wo, const Rgb& throughput = {1, 1, 1});

}  // namespace vernier
