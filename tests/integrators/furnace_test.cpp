// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

// White furnace: a lossless object in a uniform surrounding cannot be seen.

namespace vernier::test {
namespace {

struct FurnaceCase {
  const char* name;
  MaterialDescription material;
  double tolerance;
};

std::vector<FurnaceCase> cases() {
  MaterialDescription thin = glass(0.3f), mixed = glass(0.3f), dull_metal = metal(1);
  thin.thickness = 0;
  mixed.metallic = 0.4f;
  mixed.transmission = 0.5f;
  dull_metal.metallic = 0.5f;
  return {{"diffuse", diffuse(1), 1e-3},
          {"mirror", metal(0), 1e-4},
          {"metal", metal(0.3f), 1e-3},
          {"rough metal", metal(1), 3e-3},
          {"polished plastic", plastic(0), 1e-3},
          {"plastic", plastic(0.3f), 1e-3},
          {"half metal", dull_metal, 3e-3},
          {"clear glass", glass(0), 1e-3},
          {"frosted glass", glass(0.3f), 2e-2},
          {"rough glass", glass(1), 4e-2},
          {"thin glass", thin, 1e-3},
          {"mixture", mixed, 1e-2}};
}

TEST(Furnace, LosslessObjectsVanish) {
  for (const FurnaceCase& c : cases()) {
    const Scene scene = SceneBuilder()
                            .add(sphere({0, 0, 0}, 1, 24, 48), c.material)
                            .environment([](const Vec3f&) { return 1.f; }, 8)
                            .build();
    for (const auto& [x, roulette] : {std::pair(0.1f, true), std::pair(0.6f, false), std::pair(0.9f, true)}) {
      IntegratorOptions options;
      options.max_depth = 400;
      options.russian_roulette = roulette;

      EXPECT_TRUE(sees(scene, *path(options), ray_through({x, 0.2f, 4}, {x, 0, 0}), 1, c.tolerance))
          << c.name << " at " << x << (roulette ? "" : ", no roulette");
    }
  }
}

}  // namespace
}  // namespace vernier::test
