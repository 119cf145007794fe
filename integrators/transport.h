// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/integrator.h"
#include "scene/segment.h"

// Small pieces that more than one integrator needs.

namespace vernier {

/// Weight of a sample drawn with density `pdf` where another technique could have drawn it with `other_pdf`
/// (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation", eq. 9.13 with exponent 2).
inline float power_heuristic(float pdf, float other_pdf) {
  const float ratio = other_pdf / pdf;
  return 1 / (1 + ratio * ratio);
}

/// A path that a medium scatters for ever, as rounding at its boundary may let happen, ends after some more
/// than so many vertices.
constexpr int most_certain_vertices = 1000;

/// Of the paths that reach the depth limit, those that go on to tell how much light it takes.
constexpr float audited_share = 1 / 32.f;
/// Of these, the most that go on from any vertex beyond.
constexpr float most_audited_survival = 0.9f;

/// Whether a path may end by Russian roulette after that vertex, counted from 1.
inline bool is_at_risk(const IntegratorOptions& options, int vertex) {
  return (options.russian_roulette && vertex > 1) || vertex > most_certain_vertices;
}

/// Probability that it then goes on. Five times the throughput instead of the throughput itself: ending paths
/// that still carry a fifth of their light costs more in variance than it saves in rays on measured scenes.
inline float roulette_survival(const Rgb& throughput, int vertex) {
  return std::min(vertex > most_certain_vertices ? 0.99f : 1, 5 * max_component(throughput));
}

/// The same of a path from the camera, to its vertex of that number, with light of `depth` vertices.
inline float survival_probability(const IntegratorOptions& options, int vertex, int depth,
                                  const Rgb& throughput) {
  const float survival = roulette_survival(throughput, vertex);
  if (depth > options.max_depth) return std::min(most_audited_survival, survival);
  return is_at_risk(options, vertex) ? survival : 1;
}

/// Whether the first surface that scattered a path did so by a sharp lobe: then no path from a light ends
/// there, and SpecularChains look for the light of lamps.
struct SharpView {
  bool is_scattered = false, is_sharp = false;

  void scatter(bool is_delta) {
    is_sharp = is_scattered ? is_sharp : is_delta;
    is_scattered = true;
  }
};

/// What a camera makes of radiance along a segment that begins in a medium: as through a flat port from air,
/// so radiance over the squared index, which no boundary changes.
inline Rgb camera_response(const Scene& scene, const Segment& segment) {
  const Rgb& ior = scene.volumes().medium(segment.media).ior;
  return Rgb(1, 1, 1) / (ior * ior);
}

}  // namespace vernier
