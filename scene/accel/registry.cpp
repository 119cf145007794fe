// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scene/accel/accelerator.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/bvh.h"
#include "scene/accel/embree.h"
#include "scene/accel/octree.h"

namespace vernier {

std::span<const AcceleratorEntry> accelerators() {
  using enum Watertight;
  static constexpr std::array table{
      AcceleratorEntry{"embree", "Embree, robust mode: may leak at vertices", at_edges, build_embree_robust},
      AcceleratorEntry{
          "bvh", "our own, to check it: watertight at edges and vertices, the same answers on every machine",
          at_edges_and_vertices, build_bvh},
      AcceleratorEntry{"embree-fast", "Embree, fast mode: leaks at edges and vertices", nowhere,
                       build_embree_fast, true},
      AcceleratorEntry{"bvh-moeller", "our own with the Moeller-Trumbore test: leaks at edges and vertices",
                       nowhere, build_bvh_moeller, true},
      AcceleratorEntry{"octree", "triangles in every cell they touch, to compare with", at_edges_and_vertices,
                       build_octree, true},
      AcceleratorEntry{"brute_force", "every triangle for every ray, for tests", at_edges_and_vertices,
                       build_brute_force, true},
  };
  return table;
}

}  // namespace vernier
