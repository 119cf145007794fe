#pragma once

#include <span>
#include <vector>

#include "scene/lights/light.h"

namespace vernier {

/// Binary tree over lights that picks one nearly in proportion to what it may contribute to a point: by
/// power, distance, orientation and the receiver's horizon, bounded for whole subtrees (Conty Estevez and
/// Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting"; split cost and bounds as
/// there, eqs. 1 to 3).
class LightTree {
 public:
  /// bounds[i] belongs to light i; those of no power are never picked.
  explicit LightTree(std::span<const LightBounds> bounds);

  struct Pick {
    uint32_t light = 0;
    float prob = 0;  ///< 0: no light can reach the receiver
  };
  Pick sample(const LightReceiver& receiver, float u) const;
  float prob(const LightReceiver& receiver, uint32_t light) const;

 private:
  struct Node {
    LightBounds bounds;
    uint32_t right = 0;  ///< the left child follows its parent; 0: leaf
    uint32_t light = 0;
  };

  uint32_t build(std::span<const LightBounds> bounds, std::span<uint32_t> lights, uint64_t trail, int depth);

  std::vector<Node> nodes_;
  std::vector<uint64_t> trail_;  ///< by light: turns from the root, lowest bit first, 1 is right
};

}  // namespace vernier
