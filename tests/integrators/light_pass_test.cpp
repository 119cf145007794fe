// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/light_pass.h"

#include "core/base/parallel.h"
#include "core/compare/metrics.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/checkpoint.h"
#include "tests/support/effort.h"
#include "tests/support/pictures.h"
#include "tests/support/temporary_folder.h"

// What light paths bring is kept as exactly as what camera samples find: the same for any number of threads,
// wherever a render was cut, and with an error that covers it.

namespace vernier::test {
namespace {

Scene lit_glass() {
  PunctualLightDescription lamp;
  lamp.name = "lamp";
  lamp.intensity = 10;
  lamp.to_world.origin = {0, 2.5f, 0};
  return SceneBuilder()
      .add(parallelogram({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}), plastic(0.5f))
      .add(sphere({0, 0.9f, 0}, 0.5f, 8, 16), glass(0))
      .add(lamp)
      .build();
}

class LightPassTest : public testing::Test {
 protected:
  LightPassTest() {
    settings_.width = 40;
    settings_.height = 24;
    settings_.limits.spp = 40;
    settings_.light_split = {{"diffuse_direct", "diffuse_indirect"}, {{"lamps", {"lamp"}}}};
  }

  RenderState begin() const {
    const Crop part = rendered_part(settings_);
    const LightSorter sorter(settings_.light_split, scene_);
    return {part.width, part.height, settings_.adaptive, false, sorter.layers(), true};
  }
  RenderState go_on(RenderState state, RenderCallbacks callbacks = {}) const {
    const Camera camera(camera_at({0, 1.5f, 4}, {0, 0.3f, 0}, 0.6f), settings_.width, settings_.height);
    const auto integrator = make_integrator(settings_.integrator, settings_.integrator_options);
    const LightSorter sorter(settings_.light_split, scene_);
    const auto paths = light_paths_of(scene_, camera, *integrator, settings_, sorter);
    const std::atomic<bool> stop = false;
    render({scene_, camera, *integrator, settings_, Backdrop(settings_), sorter, paths ? &*paths : nullptr},
           state, stop, std::move(callbacks));
    return state;
  }

  /// Of a light path for each camera sample.
  uint64_t light_batches(uint32_t samples) const {
    const Camera camera({}, settings_.width, settings_.height);
    return LightPass(LightPaths(scene_, camera, settings_, LightPathKind::caustics), nullptr)
        .batches(samples);
  }

  const Scene scene_ = lit_glass();
  RenderSettings settings_;
};

template <typename A, typename B>
bool same_bytes(const A& a, const B& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

void expect_same(const RenderState& a, const RenderState& b) {
  EXPECT_EQ(a.light_batches, b.light_batches);
  EXPECT_TRUE(same_bytes(a.partial.film.bytes(), b.partial.film.bytes()));
  EXPECT_TRUE(same_bytes(a.partial.film.splat_bytes(), b.partial.film.splat_bytes()));
  EXPECT_EQ(a.partial.film.light_paths(), b.partial.film.light_paths());
  EXPECT_EQ(a.partial.rays.bounce, b.partial.rays.bounce);
  EXPECT_NEAR(a.partial.missing.bent.share, b.partial.missing.bent.share, 1e-6);  // sums of floats
  ASSERT_EQ(a.partial.light.size(), b.partial.light.size());
  for (size_t i = 0; i < a.partial.light.size(); ++i)
    EXPECT_TRUE(same_bytes(a.partial.light[i].film.splat_bytes(), b.partial.light[i].film.splat_bytes()));
}

TEST_F(LightPassTest, SameForAnyNumberOfThreadsAndFromAnyState) {
  std::vector<RenderState> states;
  std::optional<ThreadLimit> threads(1);
  RenderCallbacks callbacks;
  callbacks.checkpoint_interval = 0;
  callbacks.on_checkpoint = [&](const RenderState& state) { states.push_back(state); };
  const RenderState whole = go_on(begin(), std::move(callbacks));
  EXPECT_EQ(whole.light_batches, light_batches(40));
  EXPECT_EQ(whole.partial.film.light_paths()[0], whole.light_batches / 2 * LightPass::batch_size);
  EXPECT_EQ(whole.partial.film.light_paths()[1], whole.partial.film.light_paths()[0]);
  threads.emplace(3);
  expect_same(go_on(begin()), whole);
  const TemporaryFolder folder;
  const std::string file = folder.file("checkpoint");
  size_t within_light = 0;
  for (size_t i = 0; i < states.size(); i += 5) {
    within_light += states[i].light_batches > light_batches(states[i].completed_spp);
    write_checkpoint(file, {{"scene", "test"}}, states[i]);
    expect_same(go_on(*read_checkpoint(file).state), whole);
  }
  EXPECT_GT(within_light, 0u);
}

TEST_F(LightPassTest, LimitsMayGrow) {
  settings_.limits.spp = 21;
  const RenderState first = go_on(begin());
  settings_.limits.spp = 90;
  expect_same(go_on(first), go_on(begin()));
}

// A crop shows what the whole picture shows there.
TEST_F(LightPassTest, CropsGetTheSameSplats) {
  const RenderState whole = go_on(begin());
  settings_.crop = {7, 5, 20, 12};
  const RenderState part = go_on(begin());
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 20; ++x)
      for (int half = 0; half < Film::halves; ++half)
        ASSERT_EQ(part.partial.film.splat_mean(x, y, half),
                  whole.partial.film.splat_mean(x + 7, y + 5, half));
}

// Light kept apart adds up to the picture, and the lamp's comes by the lamp alone.
TEST_F(LightPassTest, PartsAddUp) {
  const auto ways_there_are = light_way_names();
  settings_.light_split = {{ways_there_are.begin(), ways_there_are.end()}, {{"lamps", {"lamp"}}}};
  const RenderResult result = go_on(begin()).partial;
  Vec3d splats(0, 0, 0);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 40; ++x) {
      const Vec3d whole = result.film.pixel(x, y);
      Vec3d ways(0, 0, 0), groups(0, 0, 0);
      for (size_t i = 0; i < result.light.size(); ++i)
        (i < light_way_count ? ways : groups) += result.light[i].film.pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(ways[c], whole[c], 1e-5 * whole[c]);
        EXPECT_NEAR(groups[c], whole[c], 1e-5 * whole[c]);
        EXPECT_EQ(result.light.back().film.pixel(x, y)[c], 0);  // the rest
      }
      splats += result.film.splat_mean(x, y, 0);
    }
  EXPECT_GT(splats.x, 0);
}

/// Root mean square of a difference of each pixel's channels, over what they truly are.
template <typename Difference>
double relative(const Image& truth, const Difference& difference) {
  double sum = 0;
  for (int y = 0; y < truth.height; ++y)
    for (int x = 0; x < truth.width; ++x) {
      const Vec3d d = difference(x, y);
      for (int c = 0; c < 3; ++c) sum += relative_squared(square(d[c]), double(truth.pixel(x, y)[c])) / 3;
    }
  return std::sqrt(sum / (truth.width * truth.height));
}

double relative_error(const Film& film, const Image& truth) {
  return relative(truth, [&](int x, int y) { return film.pixel(x, y) - Vec3d(rgb_at(truth, x, y)); });
}

double relative_difference(const Film& film, const Image& truth) {
  return relative(truth,
                  [&](int x, int y) { return (film.half_mean(x, y, 0) - film.half_mean(x, y, 1)) / 2.0; });
}

// The halves' differences tell what the splats are wrong by: their squares have the mean of the squared
// errors (Welch's test, significance 0.001). And of 40 errors, 34 or more lie below the end of their 95 %
// interval: fewer happen to one in 1000 if that is right. The reference has a fiftieth of their variance.
TEST_F(LightPassTest, ErrorCoversSplats) {
  if (thinning > 1) GTEST_SKIP() << "the reference takes too long";
  settings_.light_split = {};
  settings_.width = 24;
  settings_.height = 16;
  for (const char* integrator : {"path", "light"}) {
    settings_.integrator = integrator;
    settings_.limits.spp = 64 * 50;
    settings_.seed = 1000;
    const Image truth = go_on(begin()).partial.film.image();
    settings_.limits.spp = 64;
    int covered = 0;
    Samples told, true_error;
    for (uint64_t seed = 1; seed <= 40; ++seed) {
      settings_.seed = seed;
      const RenderResult result = go_on(begin()).partial;
      told.add(square(relative_difference(result.film, truth)));
      true_error.add(square(relative_error(result.film, truth)));
      covered += relative_error(result.film, truth) <= result.error.high;
    }
    EXPECT_GT(welch_p_value(told, true_error), 1e-3) << integrator;
    EXPECT_GE(covered, 34) << integrator;
  }
}

}  // namespace
}  // namespace vernier::test
