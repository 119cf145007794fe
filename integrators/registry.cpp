// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "core/base/names.h"
#include "integrators/integrator.h"
#include "vernier/error.h"

namespace vernier {

std::unique_ptr<Integrator> make_path(const IntegratorOptions&);
std::unique_ptr<Integrator> make_gradient(const IntegratorOptions&);
std::unique_ptr<Integrator> make_light(const IntegratorOptions&);
std::unique_ptr<Integrator> make_whitted(const IntegratorOptions&);
std::unique_ptr<Integrator> make_raycast(const IntegratorOptions&);

std::span<const IntegratorEntry> integrators() {
  static constexpr std::array<IntegratorEntry, 5> table{{
      {"path", "path tracing: all light, unbiased; tells what it cannot find", make_path, true, true},
      {"gradient", "gradient-domain path tracing: less noise in single pixels, most in rooms", make_gradient},
      {"light", "light tracing: all light but what mirrors and bending glass show the camera", make_light},
      {"whitted", "direct light, ambient, mirror reflection and refraction", make_whitted, false, true},
      {"raycast", "primary hits: normals, depth, ids, ... (--show)", make_raycast, false, true},
  }};
  return table;
}

std::unique_ptr<Integrator> make_integrator(const std::string& name, const IntegratorOptions& options) {
  const IntegratorEntry& entry = find_by_name(integrators(), "integrator", name);
  if (options.max_depth < 1)
    throw Error(ErrorKind::usage, "a path has at least one vertex; set IntegratorOptions::max_depth");
  const std::vector<std::string> shows(raycast_outputs().begin(), raycast_outputs().end());
  if (std::find(shows.begin(), shows.end(), options.show) == shows.end())
    throw_unknown_name("--show", options.show, shows);
  return entry.make(options);
}

}  // namespace vernier
