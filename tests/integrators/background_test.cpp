// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>

#include "core/image/image_io.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/checkpoint.h"
#include "integrators/render/render_state.h"
#include "scene/camera.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/session.h"

// What the camera sees behind all surfaces, apart from them: alpha, and backgrounds that light nothing.

namespace vernier::test {
namespace {

MaterialDescription thin_glass(float roughness) {
  MaterialDescription m = glass(roughness);
  m.thickness = 0;
  return m;
}

MaterialDescription leaf() {
  MaterialDescription m = diffuse(1);
  m.diffuse_transmission = 0.5f;
  m.double_sided = true;
  return m;
}

MaterialDescription veil(float alpha) {
  MaterialDescription m = diffuse(1);
  m.base_color.w = alpha;
  m.alpha_mode = AlphaMode::blend;
  m.double_sided = true;
  return m;
}

MeshDescription wall(float z) { return parallelogram({-1, -1, z}, {2, 0, 0}, {0, 2, 0}); }

/// Another integrator's light over a background of radiance 1.
class OverWhite : public Integrator {
 public:
  explicit OverWhite(std::unique_ptr<Integrator> integrator) : integrator_(std::move(integrator)) {}
  Estimate estimate(const Scene& scene, const Ray& ray, Sampler& sampler,
                    const SampleContext& context) const override {
    Estimate estimate = integrator_->estimate(scene, ray, sampler, context);
    estimate.radiance += estimate.background;
    return estimate;
  }

 private:
  std::unique_ptr<Integrator> integrator_;
};

/// The background alone.
class Transparency : public OverWhite {
 public:
  using OverWhite::OverWhite;
  Estimate estimate(const Scene& scene, const Ray& ray, Sampler& sampler,
                    const SampleContext& context) const override {
    const Estimate all = OverWhite::estimate(scene, ray, sampler, context);
    Estimate estimate;
    estimate.radiance = all.background;
    return estimate;
  }
};

IntegratorOptions apart(LightSampling sampling = LightSampling::mis) {
  return {.max_depth = 100, .light_sampling = sampling, .background_apart = true};
}

// In uniform surroundings a background of the same radiance is what was there before, whatever stands before
// it and whichever technique finds the light.
TEST(BackgroundApart, IsTheSurroundingsWhereItIsLikeThem) {
  MaterialDescription mixed = glass(0.3f), frosted_leaf = thin_glass(0.4f);
  mixed.transmission = 0.5f;
  frosted_leaf.transmission = 0.5f;
  frosted_leaf.diffuse_transmission = 0.5f;
  const std::vector<std::pair<const char*, MaterialDescription>> cases{
      {"diffuse", diffuse(1)},        {"clear glass", glass(0)}, {"frosted glass", glass(0.3f)},
      {"thin glass", thin_glass(0)},  {"mixture", mixed},        {"thin frosted glass", thin_glass(0.3f)},
      {"frosted leaf", frosted_leaf}, {"leaf", leaf()},          {"veil", veil(0.3f)}};
  for (const auto& [name, material] : cases) {
    const Scene scene = SceneBuilder()
                            .add(sphere({0, 0, 0}, 1, 16, 32), material)
                            .environment([](const Vec3f&) { return 1.f; }, 8)
                            .build();
    const Ray ray = ray_through({0.4f, 0.2f, 4}, {0.4f, 0, 0});
    for (const LightSampling sampling : {LightSampling::mis, LightSampling::bsdf})
      EXPECT_TRUE(sees(scene, OverWhite(path(apart(sampling))), ray, 1, 0.02)) << name;
  }
}

struct Clearness {
  const char* name;
  MaterialDescription material;
  double transparency;  ///< of one sheet, seen face on
};

// What a sheet lets through: 4 % of an index of 1.5 are reflected.
TEST(BackgroundApart, ShowsAsFarAsSurfacesAreClear) {
  MaterialDescription half = thin_glass(0);
  half.transmission = 0.5f;
  half.base_color = {1, 1, 1, 1};
  const std::vector<Clearness> cases{{"opaque", diffuse(1), 0},
                                     {"mirror", metal(0), 0},
                                     {"leaf", leaf(), 0},
                                     {"thin glass", thin_glass(0), 0.96},
                                     {"half glass", half, 0.48}};
  for (const Clearness& c : cases)
    for (const int sheets : {1, 2}) {
      SceneBuilder builder;
      for (int i = 0; i < sheets; ++i) builder.add(wall(float(-i)), c.material);
      const Scene scene = builder.environment([](const Vec3f&) { return 1.f; }, 8).build();
      const Ray ray = ray_through({0.1f, 0.2f, 4}, {0.1f, 0.2f, 0});
      const Transparency transparency(path(apart()));
      EXPECT_TRUE(sees(scene, transparency, ray, std::pow(c.transparency, sheets), 0.02)) << c.name << sheets;
    }
}

TEST(BackgroundApart, IsSeenByEveryIntegrator) {
  const Scene scene =
      SceneBuilder().add(wall(0), thin_glass(0)).environment([](const Vec3f&) { return 1.f; }, 8).build();
  const Ray through = ray_through({0.1f, 0.2f, 4}, {0.1f, 0.2f, 0}), past = ray_through({3, 0, 4}, {3, 0, 0});
  IntegratorOptions options = apart();
  options.max_depth = 5;
  for (const auto& [name, behind_glass] : {std::pair("path", 0.96), {"whitted", 0.96}, {"raycast", 0.0}}) {
    const Transparency transparency(make_integrator(name, options));
    EXPECT_TRUE(sees(scene, transparency, past, 1, 1e-3)) << name;
    EXPECT_TRUE(sees(scene, transparency, through, behind_glass, 5e-3)) << name;
  }
}

TEST(BackgroundApart, CountsTheCameraRaysThatMeetASurface) {
  const Scene scene = SceneBuilder().add(wall(0), thin_glass(0)).build();
  for (const char* name : {"path", "whitted", "raycast"}) {
    const auto integrator = make_integrator(name, {.max_depth = 5});
    Sampler sampler(0, 0, 0);
    EXPECT_TRUE(
        integrator->estimate(scene, ray_through({0, 0.2f, 4}, {0, 0.2f, 0}), sampler, {}).met_surface);
    EXPECT_FALSE(integrator->estimate(scene, ray_through({3, 0, 4}, {3, 0, 0}), sampler, {}).met_surface);
  }
}

/// Glass, hair cards and edges, lit by surroundings that are nothing like the background.
std::shared_ptr<const Scene> still_life() {
  SceneBuilder builder;
  std::vector<uint8_t> alphas(256);
  for (size_t i = 0; i < alphas.size(); ++i) alphas[i] = uint8_t(i % 3 == 0 ? 255 : i);
  builder.alpha_texture(16, 16, alphas);
  MaterialDescription hair = veil(1), masked = veil(1);
  hair.base_color_texture.texture = masked.base_color_texture.texture = 0;
  masked.alpha_mode = AlphaMode::mask;
  builder.add(sphere({-1, 0, 0}, 0.7f, 12, 24), glass(0))
      .add(sphere({0.6f, 0.5f, 0}, 0.5f, 12, 24), glass(0.3f))
      .add(parallelogram({0.1f, -1, 0.5f}, {0.8f, 0, 0.2f}, {0, 0.9f, 0}), hair)
      .add(parallelogram({1, -1, 0.5f}, {0.8f, 0, 0.2f}, {0, 0.9f, 0}), masked)
      .add(box({-0.3f, -1.2f, -1}, {0.3f, -0.7f, -0.5f}), plastic(0.4f))
      .environment([](const Vec3f& w) { return w.y > 0.5f ? 4.f : 0.1f; }, 16);
  SceneDescription description = builder.description();
  description.hash = "still life";
  return build_scene(std::move(description));
}

RenderSettings seen_by_a_camera() {
  RenderSettings settings;
  settings.width = 32;
  settings.height = 24;
  settings.camera.to_world.origin = {0, 0, 5};
  settings.camera.yfov = 0.7f;
  settings.adaptive = false;
  settings.limits = {.spp = 16};
  return settings;
}

LayeredImage rendered(const std::shared_ptr<const Scene>& scene, const RenderSettings& settings) {
  RenderSession session(scene, settings);
  session.run();
  return session.picture();
}

// Sample by sample, so to rounding.
TEST(Background, AlphaOverAColorIsTheRenderWithThatColor) {
  const auto scene = still_life();
  RenderSettings settings = seen_by_a_camera();
  settings.background = {.kind = Background::Kind::color, .color = {0.2f, 0.5f, 2}};
  const Image opaque = rendered(scene, settings).image;
  EXPECT_EQ(opaque.channels, 3);
  settings.background.kind = Background::Kind::transparent;
  const LayeredImage clear = rendered(scene, settings);
  EXPECT_EQ(clear.channel_names, (std::vector<std::string>{"R", "G", "B", "A"}));
  int between = 0;
  for (int y = 0; y < settings.height; ++y)
    for (int x = 0; x < settings.width; ++x) {
      const float* pixel = clear.image.pixel(x, y);
      between += pixel[3] > 0.01f && pixel[3] < 0.99f;
      const Rgb over = Rgb(pixel[0], pixel[1], pixel[2]) + Rgb(0.2f, 0.5f, 2) * (1 - pixel[3]);
      // Frosted glass may let through more than all by chance, which alpha cannot say.
      const float tolerance = pixel[3] == 0 ? 0.05f : 3e-4f;
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(opaque.pixel(x, y)[c], over[c], tolerance) << x << ", " << y;
    }
  EXPECT_GT(between, 100) << "glass, hair and edges";
}

// Rays, not the numbers of a sampler, decide what coverage lets pass.
TEST(Background, ShowsThroughVeilsAsFarAsTheyDoNotCover) {
  for (const int veils : {1, 2}) {
    SceneBuilder builder;
    for (int i = 0; i < veils; ++i)
      builder.add(parallelogram({-9, -9, -float(i)}, {18, 0, 0}, {0, 18, 0}), veil(0.3f));
    RenderSettings settings = seen_by_a_camera();
    settings.background.kind = Background::Kind::transparent;
    const Image alpha = *rendered(build_scene(builder.description()), settings).single("A");
    double mean = 0;
    for (const float value : alpha.values) mean += value / double(alpha.values.size());
    const double expected = 1 - std::pow(0.7, veils), samples = 16.0 * settings.width * settings.height;
    EXPECT_NEAR(mean, expected, 4 * std::sqrt(expected * (1 - expected) / samples));
  }
}

TEST(Background, APictureFillsTheFrameAndLightsNothing) {
  const auto scene = build_scene(SceneBuilder()
                                     .add(wall(0), diffuse(0.5f))
                                     .environment([](const Vec3f&) { return 1.f; }, 8)
                                     .description());
  const TemporaryFolder folder;
  Image picture(64, 20, 3);  // twice as wide as the frame: a quarter is cut off at either side
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c)
        picture.pixel(x, y)[c] = x < 16 || x >= 48 ? 100.f : (x < 32 ? 3.f : 5.f) + float(c);
  write_exr(folder.file("behind.exr"), picture, {"R", "G", "B"}, {});
  RenderSettings settings = seen_by_a_camera();
  settings.width = 32;
  settings.height = 20;
  settings.camera.yfov = 1.2f;
  settings.background = {.kind = Background::Kind::picture, .file = folder.file("behind.exr")};
  const Image seen = rendered(scene, settings).image;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen.pixel(2, 2)[c], 3 + c, 1e-4);
    EXPECT_NEAR(seen.pixel(29, 17)[c], 5 + c, 1e-4);
    EXPECT_NEAR(seen.pixel(16, 10)[c], 0.5, 0.1) << "what is lit";
  }
  settings.background.picture = std::make_shared<const Image>(read_background(settings.background.file));
  std::filesystem::remove(settings.background.file);
  EXPECT_EQ(rendered(scene, settings).image.values, seen.values) << "read before";
}

TEST(Background, TransparentRendersGoOnAndMerge) {
  const auto scene = still_life();
  RenderSettings settings = seen_by_a_camera();
  settings.background.kind = Background::Kind::transparent;
  settings.adaptive = true;
  settings.limits.spp = 40;
  const Image whole = rendered(scene, settings).image;

  const TemporaryFolder folder;
  settings.limits.spp = 25;
  RenderSession first(scene, settings);
  first.run();
  first.save(folder.file("a.ckpt"));
  settings.limits.spp = 40;
  RenderSession second(scene, settings);
  EXPECT_TRUE(second.load(folder.file("a.ckpt")).empty());
  second.run();
  EXPECT_EQ(second.picture().image.values, whole.values);

  settings.background.kind = Background::Kind::color;
  RenderSession other(scene, settings);
  try {
    other.load(folder.file("a.ckpt"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("background was transparent"));
  }
}

TEST(Background, AnImpossibleOneIsRefused) {
  const auto scene = still_life();
  RenderSettings settings = seen_by_a_camera();
  settings.background = {.kind = Background::Kind::color, .color = {0, -1, 0}};
  EXPECT_THROW(RenderSession(scene, settings), Error);
  settings.background = {.kind = Background::Kind::picture};
  EXPECT_THROW(RenderSession(scene, settings), Error);
  settings.background.file = "/nowhere/behind.png";
  EXPECT_THROW(RenderSession(scene, settings), Error);
  Image negative(2, 2, 3), infinite(2, 2, 3);
  negative.values[5] = -1;
  infinite.values[7] = std::numeric_limits<float>::infinity();
  for (const Image& picture : {Image(), Image(2, 2, 1), Image(2, 2, 4), negative, infinite}) {
    settings.background.picture = std::make_shared<const Image>(picture);
    EXPECT_THROW(RenderSession(scene, settings), Error);
  }
  settings.background.picture = std::make_shared<const Image>(2, 2, 3);
  EXPECT_NO_THROW(RenderSession(scene, settings));
}

TEST(Background, SettingsKeepIt) {
  RenderSettings settings = seen_by_a_camera();
  settings.background = {.kind = Background::Kind::picture, .color = {0.1f, 0.2f, 0.3f}, .file = "a b.png"};
  const Background read = RenderSettings::from_json(settings.to_json()).background;
  EXPECT_EQ(read.kind, Background::Kind::picture);
  EXPECT_EQ(read.color, settings.background.color);
  EXPECT_EQ(read.file, "a b.png");
}

}  // namespace
}  // namespace vernier::test
