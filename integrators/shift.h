// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/transport.h"

namespace vernier {

/// What happened to a path at one of its surfaces: which numbers chose the next direction, and where it led.
struct PathStep {
  float lobe_choice;
  Vec2f direction;
  const ShadingSample& next;
  const SurfacePoint& from;
  const Segment& segment;                 ///< that left the surface
  const std::optional<Interaction>& hit;  ///< at its end
  const Rgb& loss;                        ///< what gets along it
  bool can_be_joined;                     ///< by a path that is near
  const Rgb& throughput;                  ///< at its end
};

/// How the path went on from there.
struct PathSurvival {
  float probability;
  bool is_at_risk;
  int vertex;
};

/// What an emitter that a ray meets counts for, against next-event estimation: of a ray that left a surface
/// with density `pdf`.
inline float emission_weight(bool is_delta, float pdf, float light_pdf) {
  return is_delta || light_pdf == 0 ? 1 : power_heuristic(pdf, light_pdf);
}

/// What gets to the end of a segment through media that do not scatter.
Rgb loss_along(const Scene& scene, const Segment& segment, const std::optional<Interaction>& hit);

/// A path that belongs to a pixel beside that of another, the base path, and is made from it by a mapping
/// that can be undone (Lehtinen et al. 2013, "Gradient-Domain Metropolis Light Transport"; Kettunen et al.
/// 2015, "Gradient-Domain Path Tracing"). It is drawn with the base path's random numbers (replay) until that
/// has scattered broadly, as from a diffuse surface, at both ends of an edge; there it joins the base path's
/// vertex (reconnection), and shares all that follow.
///
/// All is told in the space of random numbers and, from where it joins, of vertices; in the first the mapping
/// is the identity, in the second its Jacobian is the ratio of the geometry terms. Where one end of the
/// mapping would have been mapped otherwise, or cannot carry light, the shift is dead: then the base path
/// counts for the difference alone. Both ends must judge that alike, or the differences are biased.
class Shift {
 public:
  enum class State {
    dead,
    separate,  ///< has a vertex of its own
    joined,    ///< has come to the base path's vertex, from another side
    merged     ///< came to it as the base path did
  };

  /// Begins at a camera ray of the pixel beside; dead if that is of another time, for nothing that moves is
  /// then where the base path meets it.
  void begin(const Scene& scene, const Ray& ray, const Ray& base, RayCounts& rays);
  void end() { state_ = State::dead; }
  /// Follows the base path over an edge.
  void follow(const Scene& scene, const PathStep& step, const PathSurvival& survival, RayCounts& rays);

  State state() const { return state_; }
  bool is_dead() const { return state_ == State::dead; }
  bool is_separate() const { return state_ == State::separate; }
  /// It has met nothing, and can only shine.
  bool has_left() const { return is_separate() && !hit_; }

  /// Over the density of the base path.
  const Rgb& throughput() const { return throughput_; }
  const Interaction& at() const { return *hit_; }
  const Shading& surface() const { return *surface_; }
  /// It has been scattered by narrow lobes alone.
  bool is_narrow() const { return is_narrow_; }
  /// Light of what it meets, where the base path meets `base`, weighted against next-event estimation.
  Rgb emission(const Scene& scene, const LightEval& base, bool base_is_delta) const;

  /// What a difference counts that this mapping brings and its inverse does from the other pixel: the balance
  /// heuristic between the two (Kettunen et al. 2015).
  float weight() const { return is_dead() ? 1 : 1 / (1 + ratio_); }

  /// Whether what leaves a surface depends so little on where it came from that a path may join another
  /// there.
  static bool is_broad(const Shading& surface);
  /// Whether a direction was drawn from a density so flat that it may be replaced by one nearby.
  static bool is_broad(const ShadingSample& sample) {
    return !sample.is_transmitted && !is_narrow(sample.is_delta, sample.pdf);
  }
  static bool is_narrow(bool is_delta, float pdf) { return is_delta || pdf > largest_broad_pdf; }

 private:
  static constexpr float largest_broad_pdf = 1.5f;  // of a diffuse lobe: 1 / pi

  Rgb join(const Scene& scene, const PathStep& step, RayCounts& rays);
  Rgb replay(const Scene& scene, const PathStep& step, RayCounts& rays);
  bool follow_shared(const PathStep& step);

  State state_ = State::dead;
  Rgb throughput_{1, 1, 1};
  float ratio_ = 1;  ///< of the densities of the two paths, the shift's over the base path's
  float eta_scale_ = 1;
  Segment segment_;  ///< on which it came, while that is its own
  std::optional<Interaction> hit_;
  std::optional<Shading> surface_;
  std::optional<SurfacePoint> from_;
  float pdf_ = 0;         ///< with which it left from_
  bool is_delta_ = true;  ///< it left from_ by a delta lobe
  bool is_narrow_ = true;
};

}  // namespace vernier
