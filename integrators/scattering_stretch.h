// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "integrators/transport.h"
#include "scene/lights/lamps_along_ray.h"

namespace vernier {

/// Blocks of the sampler for where a ray is scattered on its way; the lower ones are those of vertices.
constexpr uint32_t medium_blocks = 1u << 20;
/// And of those for chains of sharp lobes from a vertex to a lamp.
constexpr uint32_t chain_blocks = 1u << 21;

/// The part of a path's segment that lies in a scattering medium: where light is scattered into it. Two
/// techniques find such places, by free flight and, for lamps, by where these shine on the segment; the light
/// of lamps is weighted between them (Veach 1997, section 9.2).
class ScatteringStretch {
 public:
  /// `hit` ends the segment, if anything does; `throughput` is the throughput of the path. Scene and segment
  /// must live as long.
  ScatteringStretch(const Scene& scene, const Segment& segment, const Stretch& stretch,
                    const std::optional<Interaction>& hit, const Rgb& throughput);

  /// Moves `hit` to where light that travels along the segment is scattered first, u in [0, 1), if it is.
  /// Returns the weight of what gets there and is scattered, or of what gets to the end, over the density.
  Rgb sample(double u, std::optional<Interaction>& hit);

  /// A place where a lamp shines on the segment, with its light.
  struct LitVertex {
    Interaction at;
    Rgb weight;  ///< of what gets from there to the segment's origin if it is scattered, over the density
    LightSample light;
  };
  /// u picks the lamp, v the place. Empty when none shines on the segment.
  std::optional<LitVertex> sample_lit(float u, float v) const;

  /// Weight of light that was chosen at the vertex found by sample(), against sample_lit().
  float weight(const LightSample& light) const;

 private:
  Interaction vertex_at(float t) const;

  const Scene& scene_;
  const Segment& segment_;
  float begin_;
  float length_;  ///< along which a vertex may lie
  FreeFlight flight_;
  std::optional<LampsAlongRay> lamps_;  ///< where lamps may shine straight into the medium
  float t_ = 0;                         ///< of the vertex that sample() found
};

}  // namespace vernier
