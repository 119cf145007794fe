// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "integrators/integrator.h"

namespace vernier {

std::unique_ptr<Integrator> make_path(const IntegratorOptions&);
std::unique_ptr<Integrator> make_whitted(const IntegratorOptions&);
std::unique_ptr<Integrator> make_raycast(const IntegratorOptions&);

std::span<const IntegratorEntry> integrators() {
  static constexpr std::array<IntegratorEntry, 3> table{{
      {"path", "path tracing: all light, unbiased; tells what it cannot find", make_path},
      {"whitted", "direct light, ambient, mirror reflection and refraction", make_whitted},
      {"raycast", "primary hits: normals, depth, ids, ... (--show)", make_raycast},
  }};
  return table;
}

}  // namespace vernier
