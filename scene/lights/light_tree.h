// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "scene/lights/light_node.h"

namespace vernier {

/// Tree over lights, eight children a node, that picks one nearly in proportion to what it may contribute to
/// a point: by power, distance, orientation and the receiver's horizon, bounded for whole subtrees (Conty
/// Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; split cost and
/// bounds as there, eqs. 1 to 3). Eight children rather than two: they are weighed at once, and the coarsest
/// and worst guesses, high up, are skipped.
class LightTree {
 public:
  LightTree() = default;
  /// bounds_of(i), called from many threads, belongs to light i of `count`; those of no power are never
  /// picked.
  LightTree(size_t count, const std::function<LightBounds(size_t)>& bounds_of);

  /// What the parts of a node may send to a receiver, relative to each other, and all together; 0: nothing.
  struct Weights {
    Float8 slots{};
    double sum = 0;
  };
  /// Of the root, with which a choice for that receiver begins.
  Weights weigh(const LightReceiver& receiver) const;
  /// About the irradiance that all lights together may cause there, were nothing in between.
  double irradiance(const Weights& root) const { return power_ * root.sum / double(pi); }

  struct Pick {
    uint32_t light = 0;
    double prob = 0;  ///< 0: no light can reach the receiver
  };
  /// u in [0, 1). Lights down to a probability of 2^-40 are picked as often as `prob` says, to 2^-13 of it.
  Pick sample(const LightReceiver& receiver, double u) const { return sample(receiver, weigh(receiver), u); }
  double prob(const LightReceiver& receiver, uint32_t light) const {
    return prob(receiver, weigh(receiver), light);
  }
  /// The same where the root has been weighed already.
  Pick sample(const LightReceiver& receiver, Weights root, double u) const;
  double prob(const LightReceiver& receiver, const Weights& root, uint32_t light) const;

 private:
  static constexpr uint32_t nowhere = UINT32_MAX;

  static Weights weigh(const LightNode& node, const LightReceiver& receiver);

  std::vector<LightNode> nodes_;
  std::vector<uint32_t> places_;  ///< by light: the number of its node by a node's width, and its slot
  double power_ = 0;              ///< of all lights; the nodes hold parts of it
};

}  // namespace vernier
