// SPDX-License-Identifier: Apache-2.0
#include "vernier/session.h"

#include <gmock/gmock.h>

#include <thread>

#include "integrators/render/render.h"
#include "integrators/render/settings_identity.h"
#include "scene/camera.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"

// What others build on: sessions of their own settings, misused too.

namespace vernier::test {
namespace {

using testing::HasSubstr;

std::shared_ptr<const Scene> room(const std::string& hash = "room") {
  SceneDescription d = SceneBuilder()
                           .add(box({-1, 0, -1}, {1, 2, 1}, true), plastic(0.4f))
                           .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
                           .description();
  d.hash = hash;
  return build_scene(std::move(d));
}

RenderSettings settings_of_room() {
  RenderSettings settings;
  settings.width = 36;
  settings.height = 20;
  settings.camera.yfov = 1.2f;
  settings.camera.to_world.origin = {0, 1, 0.95f};
  settings.limits = {.spp = 40};
  return settings;
}

/// What `work` throws; empty: nothing.
template <typename Work>
std::string complaint(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(RenderSession, IsTheRenderThatItsSettingsSay) {
  const auto scene = room();
  const RenderSettings settings = settings_of_room();
  RenderSession session(scene, settings);
  EXPECT_EQ(session.run(), StopReason::samples);
  const Camera camera(settings.camera, settings.width, settings.height);
  const std::atomic<bool> stop = false;
  const RenderResult direct = render(*scene, camera, *path({}), settings, stop);
  EXPECT_EQ(session.picture().image.values, direct.film.image().values);
  EXPECT_EQ(session.status().samples, direct.samples);
  EXPECT_EQ(session.status().error.rel_rmse, direct.error.rel_rmse);
  EXPECT_EQ(session.picture("error,samples").channel_names.size(), 3u + 4 + 1);
}

TEST(RenderSession, GoesOnInPlaceAndFromAFile) {
  const auto scene = room();
  RenderSettings settings = settings_of_room();
  settings.limits.spp = 90;
  RenderSession whole(scene, settings);
  whole.run();

  settings.limits.spp = 25;
  RenderSession in_place(scene, settings);
  in_place.run();
  const TemporaryFolder folder;
  in_place.save(folder.file("a.ckpt"));
  in_place.set_limits({.spp = 90});
  in_place.run();
  EXPECT_EQ(in_place.picture().image.values, whole.picture().image.values);

  settings.limits.spp = 90;
  RenderSession elsewhere(scene, settings);
  EXPECT_TRUE(elsewhere.load(folder.file("a.ckpt")).empty());
  EXPECT_NEAR(elsewhere.status().samples_per_pixel, 25, 0.1);
  elsewhere.run();
  EXPECT_EQ(elsewhere.picture().image.values, whole.picture().image.values);
}

TEST(RenderSession, SeveralAtOnceDoNotDisturbEachOther) {
  const auto scene = room();
  RenderSettings settings = settings_of_room();
  std::array<std::vector<float>, 2> alone, together;
  const auto render_one = [&](size_t i) {
    RenderSettings own = settings;
    own.seed = i;
    RenderSession session(scene, own);
    session.run();
    return session.picture().image.values;
  };
  for (size_t i = 0; i < 2; ++i) alone[i] = render_one(i);
  std::thread other([&] { together[1] = render_one(1); });
  together[0] = render_one(0);
  other.join();
  EXPECT_EQ(alone, together);
  EXPECT_NE(alone[0], alone[1]);
}

TEST(RenderSession, TakesOneCallAtATime) {
  RenderSettings settings = settings_of_room();
  settings.limits.spp = 0;
  RenderSession session(room(), settings);
  std::atomic<bool> stop = false;
  std::atomic<bool> is_running = false;
  std::string from_callback = "not called";
  session.on_checkpoint(
      [&] {
        is_running = true;
        session.status();  // its own callback may ask
        from_callback = complaint([&] { session.run(); });
      },
      0);
  std::thread runner([&] { EXPECT_EQ(session.run(stop), StopReason::interrupted); });
  while (!is_running) std::this_thread::yield();
  EXPECT_THAT(complaint([&] { session.run(); }), HasSubstr("in use by another thread"));
  EXPECT_THAT(complaint([&] { session.picture(); }), HasSubstr("in use by another thread"));
  stop = true;
  runner.join();
  EXPECT_THAT(from_callback, HasSubstr("cannot be called by a callback"));
  EXPECT_GT(session.status().samples, 0u);
}

TEST(RenderSession, PreviewsOnTheWayChangeNothing) {
  RenderSettings settings = settings_of_room();
  RenderSession plain(room(), settings), watched(room(), settings);
  plain.run();
  size_t previews = 0;
  watched.on_preview(
      [&] {
        ++previews;
        EXPECT_LT(watched.status().samples, plain.status().samples + 1);
        EXPECT_FALSE(watched.picture().image.empty());
      },
      0);
  watched.run();
  EXPECT_GT(previews, 0u);
  EXPECT_EQ(watched.picture().image.values, plain.picture().image.values);
}

TEST(RenderSession, TheFirstPreviewComesWithTheFirstSamples) {
  RenderSession session(room(), settings_of_room());
  std::vector<uint64_t> samples;
  session.on_preview([&] { samples.push_back(session.status().samples); }, 1e9);
  session.run();
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_GT(samples[0], 0u);
  EXPECT_LT(samples[0], session.status().samples / 4);
}

TEST(RenderSession, AskedForNowPreviewAndCheckpointComeOnce) {
  RenderSettings settings = settings_of_room();
  RenderSession session(room(), settings);
  std::atomic<bool> now = true;
  size_t previews = 0, checkpoints = 0;
  const double never = std::numeric_limits<double>::infinity();
  session.on_preview([&] { ++previews; }, never, &now);
  session.on_checkpoint([&] { ++checkpoints; }, never);
  session.run();
  EXPECT_FALSE(now);
  EXPECT_EQ(previews, 1u);
  EXPECT_EQ(checkpoints, 2u) << "and at the end";
}

TEST(RenderSession, RefusesWhatCannotBeRendered) {
  const auto with = [](const std::function<void(RenderSettings&)>& change) {
    RenderSettings settings = settings_of_room();
    change(settings);
    return complaint([&] { RenderSession(room(), settings); });
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_THAT(with([](auto& s) { s.width = 0; }), HasSubstr("set RenderSettings::width and height"));
  EXPECT_THAT(with([](auto& s) { s.crop = {30, 0, 10, 10}; }), HasSubstr("reaches beyond the picture"));
  EXPECT_THAT(with([](auto& s) { s.crop = {-1, 0, 10, 10}; }), HasSubstr("reaches beyond the picture"));
  EXPECT_THAT(with([](auto& s) { s.integrator = "paht"; }), HasSubstr("did you mean 'path'"));
  EXPECT_THAT(with([](auto& s) { s.integrator_options.show = "nromal"; }), HasSubstr("normal"));
  EXPECT_THAT(with([](auto& s) { s.integrator_options.max_depth = 0; }), HasSubstr("max_depth"));
  EXPECT_THAT(with([](auto& s) { s.limits.spp = -1; }), HasSubstr("samples a pixel"));
  EXPECT_THAT(with([](auto& s) { s.limits.seconds = std::nan(""); }), HasSubstr("time limit"));
  EXPECT_THAT(with([](auto& s) { s.camera.to_world.z = {0, 0, 0}; }), HasSubstr("camera has no direction"));
  EXPECT_THAT(with([](auto& s) { s.camera.lens_radius = -1; }), HasSubstr("lens of radius -1 m"));
  EXPECT_THAT(with([](auto& s) { s.camera.focus_distance = 0; }), HasSubstr("focus distance of 0 m"));
  for (const auto kind : {CameraDescription::Kind::orthographic, CameraDescription::Kind::panorama})
    EXPECT_THAT(with([kind](auto& s) {
                  s.camera.kind = kind;
                  s.camera.lens_radius = 0.1f;
                }),
                HasSubstr("only a perspective camera has a lens"));
  EXPECT_THAT(with([](auto& s) { s.filter.width = 0; }), HasSubstr("expected 0.1 to 16"));
  EXPECT_THAT(complaint([] { RenderSession(nullptr, settings_of_room()); }), HasSubstr("needs a scene"));
  RenderSession nameless(room(""), settings_of_room());
  const TemporaryFolder folder;
  EXPECT_THAT(complaint([&] { nameless.save(folder.file("a.ckpt")); }),
              HasSubstr("set SceneDescription::hash"));
  EXPECT_TRUE(folder.names().empty());
}

TEST(RenderSession, LoadsNoOtherRender) {
  const TemporaryFolder folder;
  RenderSession(room(), settings_of_room()).save(folder.file("a.ckpt"));
  const auto load = [&](const std::shared_ptr<const Scene>& scene,
                        const std::function<void(RenderSettings&)>& change) {
    RenderSettings settings = settings_of_room();
    change(settings);
    RenderSession session(scene, settings);
    return complaint([&] { session.load(folder.file("a.ckpt")); });
  };
  EXPECT_EQ(load(room(), [](auto&) {}), "");
  EXPECT_EQ(load(room(), [](auto& s) { s.limits = {.spp = 7, .seconds = 3, .error = 0.1}; }), "");
  EXPECT_THAT(load(room("other"), [](auto&) {}), HasSubstr("scene was room, is other"));
  EXPECT_THAT(load(room(), [](auto& s) { s.camera.yfov = 1; }), HasSubstr("camera was"));
  EXPECT_THAT(load(room(), [](auto& s) { s.camera.to_world.origin.x = 0.1f; }), HasSubstr("camera was"));
  EXPECT_THAT(load(room(), [](auto& s) { s.camera.lens_radius = 0.1f; }), HasSubstr("camera was"));
  EXPECT_THAT(load(room(), [](auto& s) { s.filter.width = 2; }), HasSubstr("filter was box:1, is box:2"));
  EXPECT_THAT(load(room(), [](auto& s) { s.width = 40; }), HasSubstr("size was 36x20, is 40x20"));
  EXPECT_THAT(load(room(), [](auto& s) { s.integrator_options.russian_roulette = false; }),
              HasSubstr("roulette was on, is off"));
  EXPECT_THAT(load(room(), [](auto& s) { s.integrator_options.light_sampling = LightSampling::bsdf; }),
              HasSubstr("light-sampling was mis, is bsdf"));
}

TEST(RenderSettingsJson, HoldsAllThatSamplesDependOn) {
  RenderSettings settings = settings_of_room();
  settings.crop = {3, 4, 10, 12};
  settings.integrator = "whitted";
  settings.integrator_options = {.max_depth = 5,
                                 .light_sampling = LightSampling::light,
                                 .russian_roulette = false,
                                 .caustics = Caustics::off,
                                 .show = "id",
                                 .ambient = 0.1f,
                                 .cutoff = 0.3f};
  settings.adaptive = false;
  settings.seed = 0xfedcba9876543210u;
  settings.camera.name = "b\"ack";
  settings.camera.kind = CameraDescription::Kind::panorama;
  settings.camera.lens_radius = 0.25f;
  settings.camera.focus_distance = std::numeric_limits<float>::infinity();
  settings.filter = {PixelFilter::Kind::gaussian, 2.5f};
  settings.limits = {.spp = 3, .seconds = 4.5, .error = 0.01};
  const RenderSettings again = RenderSettings::from_json(settings.to_json());
  EXPECT_EQ(again.to_json(), settings.to_json());
  EXPECT_EQ(identity_of(again), identity_of(settings));
  EXPECT_EQ(again.seed, settings.seed);
  EXPECT_EQ(again.camera.kind, CameraDescription::Kind::panorama);
  EXPECT_EQ(again.camera.lens_radius, 0.25f);
  EXPECT_TRUE(std::isinf(again.camera.focus_distance));
  EXPECT_EQ(again.filter.kind, PixelFilter::Kind::gaussian);
  EXPECT_EQ(again.filter.width, 2.5f);
  EXPECT_EQ(again.limits.seconds, 4.5);
  EXPECT_TRUE(std::isinf(RenderSettings::from_json(settings_of_room().to_json()).limits.seconds));
}

TEST(RenderSettingsJson, RefusesWhatIsNone) {
  const std::string good = settings_of_room().to_json();
  const auto read = [](const std::string& text) {
    return complaint([&] { RenderSettings::from_json(text); });
  };
  EXPECT_EQ(read(good), "");
  EXPECT_THAT(read(""), HasSubstr("settings: cannot be read"));
  EXPECT_THAT(read("[]"), HasSubstr("settings: cannot be read"));
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return read(text.replace(at, from.size(), to));
  };
  EXPECT_THAT(changed("\"vernier_settings\": 2", "\"vernier_settings\": 3"), HasSubstr("are of format 3"));
  EXPECT_THAT(changed("\"seed\"", "\"sed\""), HasSubstr("seed"));
  EXPECT_THAT(changed("\"mis\"", "\"mas\""), HasSubstr("mis"));
  EXPECT_THAT(changed("\"perspective\"", "\"fisheye\""), HasSubstr("fisheye"));
}

}  // namespace
}  // namespace vernier::test
