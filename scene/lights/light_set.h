// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/sampling/distribution.h"
#include "scene/lights/light_tree.h"
#include "scene/lights/punctual.h"
#include "scene/lights/triangle_lights.h"

namespace vernier {

/// All lights of a scene, and the choice among them. Those with a place are chosen by a tree that knows where
/// they are, those at infinity in proportion to their irradiance, and between the two the irradiances decide
/// that they may cause at the receiver.
class LightSet {
 public:
  LightSet() = default;
  /// A light of no power is never chosen.
  LightSet(TriangleLights triangles, std::vector<std::unique_ptr<PunctualLight>> lamps);

  /// Puts a light at infinity behind all others, in place of the one put there before, if any; null: none.
  void set_environment(std::unique_ptr<Light> environment);

  struct Choice {
    const Light* light = nullptr;
    float prob = 0;
  };
  /// A light that may shine on the receiver; null when there is none. u in [0, 1).
  Choice choose(const LightReceiver& receiver, double u) const;
  /// Probability that choose() picks light i.
  float prob(const LightReceiver& receiver, size_t i) const;

  /// Those that no ray meets: punctual ones.
  const std::vector<const Light*>& delta_lights() const { return delta_lights_; }

  /// Triangles, lamps, the environment.
  size_t size() const { return triangles_.lights.size() + others_.size(); }
  const Light& operator[](size_t i) const {
    const size_t triangles = triangles_.lights.size();
    if (i < triangles) return triangles_.lights[i];
    return *others_[i - triangles];
  }

 private:
  /// Probability that the tree chooses, by what its root may send to the receiver.
  double finite_share(const LightTree::Weights& root) const;

  void collect_infinite();

  TriangleLights triangles_;
  std::vector<std::unique_ptr<Light>> others_;
  bool has_environment_ = false;
  std::vector<const Light*> delta_lights_;
  bool is_single_ = false;  ///< there is one light, and nothing to choose
  std::vector<const Light*> infinite_lights_;
  AliasTable infinite_;                 ///< over infinite_lights_, by irradiance
  std::vector<int32_t> infinite_slot_;  ///< of others_: index in infinite_lights_, or -1
  LightTree tree_;                      ///< over all others
};

}  // namespace vernier
