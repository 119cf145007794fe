// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "integrators/light_emission.h"
#include "integrators/specular_chain.h"
#include "scene/lights/punctual.h"
#include "vernier/result.h"

namespace vernier {

/// Finds light of lamps that reaches a point by chains of sharp reflections and refractions, where neither a
/// shadow ray nor the lens of the camera can be aimed at: specular manifold sampling (Zeltner, Georgiev and
/// Jakob 2020, "Specular Manifold Sampling for Rendering High-Frequency Caustics and Glints", section 4). A
/// random chain is turned at the point until it meets the lamp, by Newton's method; how probable the chain
/// found was, is told without bias by how often it must be tried to be found again.
class SpecularChains {
 public:
  /// `emission`: of the lamps of the scene, which must live as long.
  SpecularChains(const Scene& scene, std::shared_ptr<const LightEmission> emission);

  /// Where light arrives, and what it is worth there.
  struct Receiver {
    const Interaction& at;
    const Shading& surface;
    const Rgb& throughput;
    float spread;  ///< as of SampleContext; 0: all that is found is looked for again
  };
  struct Arrival {
    Rgb radiance;  ///< toward the viewer, throughput included
    Rgb rest;      ///< about what is left out: of chains too improbable to be found again
    Vec3f wi;      ///< where it comes from
    int surfaces;  ///< on its way
    LightSource source;
  };
  /// Light of one chain, if any is found, such that the mean over random `seed` is that of all of them. Light
  /// that arrives straight is none of it. Adds the rays that it takes.
  std::optional<Arrival> sample(const Receiver& receiver, uint64_t seed, RayCounts& rays) const;

 private:
  class Search;

  const Scene& scene_;
  std::shared_ptr<const LightEmission> emission_;
  std::vector<const PunctualLight*> lamps_;  ///< by the numbers of `emission`
  bool disperses_ = false;                   ///< some boundary bends colors differently
  bool lamps_are_in_air_ = true;             ///< certainly, and always
};

}  // namespace vernier
