// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/parallel.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/checkpoint.h"
#include "scene/camera.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

Scene room() {
  return SceneBuilder()
      .add(box({-1, 0, -1}, {1, 2, 1}, true), plastic(0.4f))
      .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
      .build();
}

/// Renders a room of 3 x 2 tiles; each test says how far.
class Resume : public testing::Test {
 protected:
  Resume() {
    options_.width = 36;
    options_.height = 20;
    CameraDescription view;
    view.yfov = 1.2f;
    view.to_world.origin = {0, 1, 0.95f};
    camera_.emplace(view, options_.width, options_.height);
  }

  RenderResult run(RenderCallbacks callbacks = {}) {
    stop_ = false;
    return render(scene_, *camera_, *integrator_, options_, stop_, std::move(callbacks));
  }
  RenderResult go_on(const RenderState& state) {
    RenderState further = state;
    stop_ = false;
    vernier::render({scene_, *camera_, *integrator_, options_, Backdrop(options_), LightSorter({}, scene_)},
                    further, stop_);
    return std::move(further.partial);
  }
  /// The state at the end of a render.
  RenderState last_state() {
    std::optional<RenderState> last;
    RenderCallbacks callbacks;
    callbacks.on_checkpoint = [&](const RenderState& state) { last = state; };
    run(std::move(callbacks));
    return *last;
  }

  const Scene scene_ = room();
  const std::unique_ptr<Integrator> integrator_ = path({.max_depth = 3});
  RenderSettings options_;
  std::optional<Camera> camera_;
  std::atomic<bool> stop_ = false;
};

void expect_same(const RenderResult& a, const RenderResult& b, const std::string& where) {
  EXPECT_EQ(a.film.image().values, b.film.image().values) << where;
  EXPECT_EQ(a.samples, b.samples) << where;
  EXPECT_EQ(a.rays.shadow, b.rays.shadow) << where;
  EXPECT_EQ(a.error.rel_rmse, b.error.rel_rmse) << where;
  EXPECT_EQ(a.reason, b.reason) << where;
  for (int y = 0; y < a.film.height(); ++y)
    for (int x = 0; x < a.film.width(); ++x)
      for (int half = 0; half < Film::halves; ++half)
        ASSERT_EQ(a.film.samples(x, y, half), b.film.samples(x, y, half)) << where;
}

// Wherever it was cut, between passes and within them, the picture is the one that was never cut.
TEST_F(Resume, SameFromAnyTile) {
  options_.limits.spp = 40;  // within the pass from 32 to 48
  for (const bool adaptive : {true, false}) {
    options_.adaptive = adaptive;
    std::optional<ThreadLimit> one_thread(1);
    std::vector<RenderState> states;
    RenderCallbacks callbacks;
    callbacks.checkpoint_interval = 0;
    callbacks.on_checkpoint = [&](const RenderState& state) { states.push_back(state); };
    const RenderResult whole = run(std::move(callbacks));
    expect_same(run(), whole, "not saved");
    ASSERT_EQ(states.size(), 1 + 6 * 6u);  // six passes of six tiles, and the end
    one_thread.reset();
    size_t within = 0;
    for (size_t i = 0; i < states.size(); ++i) {
      within += states[i].pass.size() > 0;
      const ThreadLimit threads(1 + i % 2);
      expect_same(go_on(states[i]), whole, "state " + std::to_string(i) + (adaptive ? "" : ", not adaptive"));
    }
    EXPECT_GT(within, 5u);
  }
}

TEST_F(Resume, LimitsMayGrow) {
  for (const bool adaptive : {true, false}) {
    options_.adaptive = adaptive;
    // One sample a pixel, between passes, within passes.
    for (const int first : {1, 16, 21, 83}) {
      options_.limits.spp = first;
      const RenderState state = last_state();
      EXPECT_NEAR(double(state.partial.samples) / (36 * 20), first, 0.01 * first) << first;
      options_.limits.spp = 90;
      const RenderResult resumed = go_on(state);
      expect_same(resumed, run(), "from " + std::to_string(first));
      EXPECT_GT(resumed.seconds, state.partial.seconds);
    }
  }
}

TEST_F(Resume, StoppedBySignalGoesOn) {
  options_.limits.spp = 70;
  const RenderResult whole = run();
  for (const int cut : {2, 9, 14}) {
    int saves = 0;
    std::optional<RenderState> last;
    RenderCallbacks callbacks;
    callbacks.checkpoint_interval = 0;
    callbacks.on_checkpoint = [&](const RenderState& state) {
      last = state;
      if (++saves == cut) stop_ = true;
    };
    const RenderResult stopped = run(std::move(callbacks));
    ASSERT_EQ(stopped.reason, StopReason::interrupted);
    EXPECT_EQ(stopped.samples, last->partial.samples) << "nothing is lost";
    EXPECT_LT(stopped.samples, whole.samples);
    expect_same(go_on(*last), whole, "cut " + std::to_string(cut));
  }
}

TEST_F(Resume, TargetIsLookedAtWhereItWouldHaveBeen) {
  options_.limits.spp = 100;
  // Reached within the pass that ends at 100 samples, so a look in the midst of it would end it early.
  options_.limits.error = 1.04 * run().error.rel_rmse;
  options_.limits.spp = 0;
  const RenderResult whole = run();
  ASSERT_EQ(whole.reason, StopReason::error);
  const double spp = double(whole.samples) / (36 * 20);
  ASSERT_GT(spp, 40);
  std::vector<RenderState> states;
  RenderCallbacks callbacks;
  callbacks.checkpoint_interval = 0;
  callbacks.on_checkpoint = [&](const RenderState& state) { states.push_back(state); };
  run(std::move(callbacks));
  for (size_t i = 0; i < states.size(); i += i + 8 < states.size() ? 3 : 1)
    expect_same(go_on(states[i]), whole, "state " + std::to_string(i));
  // It is enough already.
  options_.limits.error *= 2;
  const RenderResult again = go_on(states.back());
  EXPECT_EQ(again.samples, whole.samples);
  EXPECT_EQ(again.reason, StopReason::error);
}

TEST_F(Resume, NothingIsRenderedWhenItIsEnough) {
  options_.limits.spp = 40;
  const RenderState state = last_state();
  for (const int spp : {40, 33, 20, 1}) {
    options_.limits.spp = spp;
    const RenderResult result = go_on(state);
    EXPECT_EQ(result.samples, state.partial.samples);
    EXPECT_EQ(result.reason, StopReason::samples);
    EXPECT_EQ(result.film.image().values, state.partial.film.image().values);
  }
  options_.limits.spp = 400;
  options_.limits.seconds = state.partial.seconds / 2;
  EXPECT_EQ(go_on(state).reason, StopReason::time);
  EXPECT_EQ(go_on(state).samples, state.partial.samples);
}

/// A checkpoint within a pass, in a file.
class CheckpointFile : public Resume {
 protected:
  CheckpointFile() {
    options_.limits.spp = 40;
    write_checkpoint(path_, identity_, last_state());
  }
  std::string complaint(const std::string& bytes) {
    const std::string path = folder_.write("b.ckpt", bytes);
    try {
      read_checkpoint(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), testing::StartsWith(path + ": "));
      return error.what();
    }
    return "no complaint";
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_.file("a.ckpt");
  const RenderIdentity identity_{{"seed", "1"}, {"camera", "\u00e4"}};
};

TEST_F(CheckpointFile, HoldsAll) {
  const Checkpoint checkpoint = read_checkpoint(path_);
  EXPECT_EQ(checkpoint.identity, identity_);
  const RenderState& state = *checkpoint.state;
  EXPECT_EQ(state.pass.size(), 16u);
  EXPECT_EQ(state.completed_spp, 32u);
  EXPECT_EQ(state.partial.convergence.size(), 2u);
  options_.limits.spp = 70;
  expect_same(go_on(state), run(), "from a file");
  // The same file again.
  write_checkpoint(folder_.file("c.ckpt"), identity_, state);
  EXPECT_EQ(read_file(folder_.file("c.ckpt")), read_file(path_));
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.ckpt", "c.ckpt"}));
}

// A checkpoint holds all of a state, so its arrays are what a state takes.
TEST_F(CheckpointFile, BytesPerPixelAreThoseOfTheState) {
  const auto bytes_of = [&](bool adaptive) {
    options_.adaptive = adaptive;
    write_checkpoint(path_, {}, last_state());
    const std::string file = read_file(path_);
    return double(file.size()) / (options_.width * options_.height);
  };
  // Beside them there are header, parts and looks.
  constexpr double rest = 2500.0 / (36 * 20);
  for (const bool adaptive : {true, false}) {
    const auto expected = double(RenderState::bytes_per_pixel(adaptive, false));
    const double stored = bytes_of(adaptive);
    EXPECT_GT(stored, expected);
    EXPECT_LT(stored, expected + rest);
  }
}

TEST_F(CheckpointFile, DamageIsFound) {
  const std::string bytes = read_file(path_);
  ASSERT_GT(bytes.size(), 36u * 20 * 100);
  for (size_t length = 0; length < bytes.size(); length += 1 + length / 7)
    EXPECT_THAT(complaint(bytes.substr(0, length)), testing::Not(HasSubstr("no complaint"))) << length;
  EXPECT_THAT(complaint(bytes.substr(0, bytes.size() - 1)), HasSubstr("is damaged"));
  EXPECT_THAT(complaint(bytes + "x"), HasSubstr("is damaged"));
  for (size_t at = 0; at < bytes.size(); at += 1 + at / 5) {
    std::string changed = bytes;
    changed[at] = char(changed[at] ^ 4);
    EXPECT_THAT(complaint(changed), testing::Not(HasSubstr("no complaint"))) << at;
  }
  EXPECT_THAT(complaint("glTF and so on, at least as long as a checkpoint begins"),
              HasSubstr("is not a checkpoint"));
  std::string newer = bytes;
  newer[8] = 9;
  EXPECT_THAT(complaint(newer), HasSubstr("format 9; this version reads format 6"));
}

TEST_F(CheckpointFile, CannotBeReadOrWritten) {
  EXPECT_THROW(read_checkpoint(folder_.file("none.ckpt")), Error);
  EXPECT_THROW(read_checkpoint(folder_.path().string()), Error);
  EXPECT_THROW(write_checkpoint(folder_.file("no/a.ckpt"), identity_, last_state()), Error);
}

TEST(RenderIdentityTest, NamesWhatDiffers) {
  const RenderIdentity a{{"seed", "1"}, {"size", "4x4"}, {"crop", "2x2+0+0"}};
  const RenderIdentity b{{"seed", "2"}, {"size", "4x4"}, {"show", "depth"}};
  EXPECT_NO_THROW(require_same_render("a.ckpt", a, a));
  try {
    require_same_render("a.ckpt", a, b);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a.ckpt: is of another render: seed was 1, is 2; show was none, is depth; crop was 2x2+0+0, "
                 "is none");
  }
}

}  // namespace
}  // namespace vernier::test
