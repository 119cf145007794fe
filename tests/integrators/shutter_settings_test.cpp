// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "integrators/render/settings_identity.h"
#include "tests/support/test_scenes.h"
#include "vernier/error.h"
#include "vernier/session.h"

namespace vernier::test {
namespace {

RenderSettings moving_settings() {
  RenderSettings settings;
  settings.width = settings.height = 4;
  settings.limits.spp = 1;
  settings.row_exposure = 0.25f;
  for (const float x : {0.f, 1.f, 3.f}) settings.camera.moments.push_back({.origin = {x, 0.5f, 2}});
  settings.camera.to_world = settings.camera.moments[1];
  return settings;
}

TEST(ShutterSettings, GoThroughJson) {
  const RenderSettings settings = moving_settings();
  const RenderSettings again = RenderSettings::from_json(settings.to_json());
  EXPECT_EQ(again.camera.moments, settings.camera.moments);
  EXPECT_EQ(again.row_exposure, settings.row_exposure);
  EXPECT_EQ(again.to_json(), settings.to_json());
}

TEST(ShutterSettings, TellRendersApart) {
  const RenderSettings settings = moving_settings();
  RenderSettings other = settings;
  other.camera.moments[2].origin.x = 4;
  EXPECT_NE(identity_of(settings), identity_of(other));
  other = settings;
  other.row_exposure = 1;
  EXPECT_NE(identity_of(settings), identity_of(other));
}

TEST(ShutterSettings, ThatThereCannotBeAreRefused) {
  SceneBuilder builder;
  builder.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), emitter(1));
  const auto scene = build_scene(builder.description());
  const auto refusal = [&](const RenderSettings& settings) -> std::string {
    try {
      const RenderSession session(scene, settings);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  RenderSettings settings = moving_settings();
  EXPECT_EQ(refusal(settings), "");
  settings.row_exposure = 1.5f;
  EXPECT_THAT(refusal(settings), testing::HasSubstr("rows that are exposed for 1.5 of the shutter"));
  settings = moving_settings();
  settings.camera.moments.pop_back();
  settings.camera.moments.pop_back();
  EXPECT_THAT(refusal(settings), testing::HasSubstr("the camera has 1 moments"));
}

}  // namespace
}  // namespace vernier::test
