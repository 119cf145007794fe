#include <array>

#include "scene/accel/accelerator.h"
#include "scene/accel/embree.h"

namespace vernier {

std::span<const AcceleratorEntry> accelerators() {
  static constexpr std::array table{
      AcceleratorEntry{"embree", "Embree in robust mode: no leaks at edges", build_embree_robust},
      AcceleratorEntry{"embree-fast", "Embree in fast mode: leaks at edges and vertices", build_embree_fast},
  };
  return table;
}

}  // namespace vernier
