// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/scene/import_support.h"

namespace vernier::test {

/// Two glowing triangles, of which the first moves along x from 0 to 1 between 0 and 1 s.
inline GltfFile animated_scene() {
  GltfFile file;
  const int material = file.add("materials", {{"emissiveFactor", {1, 0.5, 0.25}}, {"doubleSided", true}});
  file.add_triangle({{"material", material}});
  file.add_root({{"mesh", 0}, {"translation", {-1, 0.5, 0}}});
  const int input = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  const int output = file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3");
  file.add("animations",
           {{"name", "slide"},
            {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
            {"samplers", {{{"input", input}, {"output", output}}}}});
  return file;
}

}  // namespace vernier::test
