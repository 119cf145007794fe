#include <array>

#include "scene/accel/accelerator.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/bvh.h"
#include "scene/accel/embree.h"
#include "scene/accel/octree.h"

namespace vernier {

std::span<const AcceleratorEntry> accelerators() {
  static constexpr std::array table{
      AcceleratorEntry{"embree", "Embree in robust mode: no leaks at edges", build_embree_robust},
      AcceleratorEntry{"embree-fast", "Embree in fast mode: leaks at edges and vertices", build_embree_fast},
      AcceleratorEntry{"bvh", "our own, watertight at edges and vertices: the reference", build_bvh},
      AcceleratorEntry{"bvh-moeller", "our own with the test of Moeller and Trumbore, which leaks",
                       build_bvh_moeller},
      AcceleratorEntry{"octree", "triangles in every cell they touch, to compare with bvh", build_octree},
      AcceleratorEntry{"brute_force", "every triangle for every ray, for tests", build_brute_force},
  };
  return table;
}

}  // namespace vernier
