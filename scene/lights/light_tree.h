#pragma once

#include <span>
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
  /// bounds[i] belongs to light i; those of no power are never picked.
  explicit LightTree(std::span<const LightBounds> bounds);

  struct Pick {
    uint32_t light = 0;
    float prob = 0;  ///< 0: no light can reach the receiver
  };
  Pick sample(const LightReceiver& receiver, float u) const;
  float prob(const LightReceiver& receiver, uint32_t light) const;

 private:
  struct BinaryNode {
    LightBounds bounds;
    uint32_t right = 0;  ///< the left child follows its parent; 0: leaf
    uint32_t light = 0;
  };
  struct Place {
    uint32_t node = 0, slot = LightNode::width;  ///< no slot: never picked
  };

  static void build(std::vector<BinaryNode>& nodes, std::span<const LightBounds> bounds,
                    std::span<uint32_t> lights, int depth);
  uint32_t widen(const std::vector<BinaryNode>& binary, uint32_t root, uint32_t parent, uint32_t slot);

  std::vector<LightNode> nodes_;
  std::vector<Place> places_;  ///< by light
};

}  // namespace vernier
