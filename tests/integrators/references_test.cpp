// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "core/image/image_io.h"
#include "integrators/render/render.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "tests/support/test_scenes.h"
#include "vernier/scene.h"

// Pictures against those of other renderers, where their files lie beside the checkout.

namespace vernier::test {
namespace {

constexpr int size = 256, block = 32;

struct Reference {
  const char* scene;
  std::vector<const char*> renderers;
};

double block_mean(const Image& image, int x0, int y0, int side) {
  double sum = 0;
  for (int y = y0; y < y0 + side; ++y)
    for (int x = x0; x < x0 + side; ++x)
      for (int c = 0; c < 3; ++c) sum += image.pixel(x, y)[c];
  return sum / (3.0 * side * side);
}

class References : public ::testing::TestWithParam<Reference> {};

// References have 1,024 samples a pixel; two of them differ by 0.6 % in the worst block.
TEST_P(References, AgreeInTheMeanOfEveryBlock) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "takes minutes with sanitizers";
#endif
  const std::filesystem::path folder = std::filesystem::path(VERNIER_SOURCE_DIR) / "../shared/scenes";
  const std::string name = GetParam().scene;
  if (!std::filesystem::exists(folder / "references")) GTEST_SKIP() << folder << " is not there";
  SceneDescription description = import_scene(folder / (name + ".glb"));
  const Camera camera(description.cameras.at(0), size, size);
  const Scene scene(std::move(description), {});
  RenderSettings options;
  options.width = options.height = size;
  options.limits.spp = 256;
  options.adaptive = false;  // which would spare the dark blocks their samples
  const std::atomic<bool> stop = false;
  const Image ours = render(scene, camera, *path({}), options, stop).film.image();
  for (const std::string renderer : GetParam().renderers) {
    const Image theirs = read_image(folder / "references" / fmt::format("{}.{}.exr", name, renderer));
    ASSERT_EQ(theirs.width, size);
    ASSERT_EQ(theirs.height, size);
    EXPECT_NEAR(block_mean(ours, 0, 0, size) / block_mean(theirs, 0, 0, size), 1, 0.002) << renderer;
    for (int y = 0; y < size; y += block)
      for (int x = 0; x < size; x += block)
        EXPECT_NEAR(block_mean(ours, x, y, block) / block_mean(theirs, x, y, block), 1, 0.01)
            << renderer << ' ' << x << ',' << y;
  }
}

INSTANTIATE_TEST_SUITE_P(Cornell, References,
                         ::testing::Values(Reference{"cornell", {"cycles3"}},
                                           Reference{"cornell_grey", {"cycles3", "pbrt"}}),
                         [](const auto& reference) { return reference.param.scene; });

}  // namespace
}  // namespace vernier::test
