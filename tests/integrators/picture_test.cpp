// SPDX-License-Identifier: Apache-2.0
#include "vernier/picture.h"

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/session.h"

// What others do with pictures.

namespace vernier::test {
namespace {

using testing::HasSubstr;

class Pictures : public testing::Test {
 protected:
  static std::shared_ptr<const Scene> room() {
    SceneDescription d = SceneBuilder()
                             .add(box({-1, 0, -1}, {1, 2, 1}, true), plastic(0.4f))
                             .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
                             .description();
    d.hash = "room";
    return build_scene(std::move(d));
  }

  /// A session that has run.
  static std::unique_ptr<RenderSession> rendered(int spp, uint64_t seed = 0) {
    RenderSettings settings;
    settings.width = 36;
    settings.height = 20;
    settings.seed = seed;
    settings.camera.yfov = 1.2f;
    settings.camera.to_world.origin = {0, 1, 0.95f};
    settings.limits = {.spp = spp};
    auto session = std::make_unique<RenderSession>(room(), settings);
    session->run();
    return session;
  }

  const TemporaryFolder folder_;
};

TEST_F(Pictures, AreWrittenWithWhatIsKnownOfThem) {
  const auto session = rendered(8);
  const LayeredImage picture = session->picture("error");
  const std::string written = folder_.file("written.exr"), directly = folder_.file("directly.exr");
  write_picture(written, picture);
  session->write(directly, "error");
  EXPECT_EQ(read_file(written), read_file(directly));
  const LayeredImage read = read_picture(written);
  EXPECT_EQ(read.image.values, picture.image.values);
  EXPECT_EQ(read.channel_names, picture.channel_names);
  EXPECT_EQ(read.metadata.at("vernier:samplesPerPixel"), "8");
  const std::vector<unsigned char> bytes = encode_picture("exr", picture);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), read_file(written));
}

TEST_F(Pictures, KeepTheirTextsInDisplayFiles) {
  const LayeredImage picture = rendered(8)->picture();
  for (const char* name : {"a.png", "a.jpg"}) {
    write_picture(folder_.file(name), picture);
    const LayeredImage read = read_picture(folder_.file(name));
    EXPECT_FALSE(read.linear);
    EXPECT_EQ(read.metadata.at("vernier:relRmse"), picture.metadata.at("vernier:relRmse")) << name;
    EXPECT_EQ(read.metadata.at("vernier:view"), "ACES SDR") << name;
  }
}

TEST_F(Pictures, AreShownByAnyBeginningOfAView) {
  const LayeredImage picture = rendered(8)->picture();
  const Image8 neutral = to_display(picture, {.view = "neu", .exposure = 1});
  EXPECT_EQ(neutral.values, to_display(picture, {.view = "neutral", .exposure = 1}).values);
  EXPECT_NE(neutral.values, to_display(picture).values);
  EXPECT_EQ(display_views().front(), "ACES SDR");
}

TEST_F(Pictures, AreCloserToTheTruthDenoised) {
  LayeredImage picture = rendered(16)->picture(layers_for_denoising);
  const LayeredImage truth = rendered(1024, 1)->picture();
  const double noisy = std::sqrt(compare(picture, truth).at("relmse"));
  const auto error = denoise(picture);
  ASSERT_TRUE(error);
  const double clean = std::sqrt(compare(picture, truth).at("relmse"));
  EXPECT_LT(clean, 0.7 * noisy);
  EXPECT_NEAR(error->noisy, noisy, 0.3 * noisy);
  EXPECT_NEAR(error->rel_rmse, clean, 0.5 * clean);
  EXPECT_EQ(picture.metadata.at("vernier:denoiser"), "nlm");
}

TEST_F(Pictures, TellOfTheirDifference) {
  const LayeredImage picture = rendered(8)->picture("error");
  LayeredImage other = picture;
  other.image.pixel(3, 5)[1] += 2;
  const auto figures = compare(other, picture);
  EXPECT_NEAR(figures.at("largest"), 2, 1e-5);
  EXPECT_NEAR(figures.at("mse"), 4.0 / (36 * 20 * 3), 1e-6);
  EXPECT_EQ(figures.count("alpha"), 0u) << "neither has any";
  other.linear = false;
  EXPECT_THROW(compare(other, picture), Error);
}

TEST_F(Pictures, OfSeveralSeedsAreMerged) {
  std::vector<std::string> files;
  double samples = 0;
  for (const uint64_t seed : {1, 2}) {
    const auto session = rendered(8, seed);
    samples += double(session->status().samples);
    files.push_back(folder_.file(std::to_string(seed)));
    session->save(files.back());
  }
  const MergedRender merged = merge(files, "error");
  EXPECT_EQ(double(merged.status.samples), samples);
  const LayeredImage first = rendered(8, 1)->picture(), second = rendered(8, 2)->picture();
  const float mean = (first.image.pixel(7, 9)[0] + second.image.pixel(7, 9)[0]) / 2;
  EXPECT_NEAR(merged.picture.image.pixel(7, 9)[0], mean, 1e-5f * mean) << "both had eight samples there";
  EXPECT_EQ(merged.picture.metadata.at("vernier:seed"), "1 2");
  EXPECT_TRUE(merged.picture.layer("error"));
  try {
    merge({files[0], files[0]});
    FAIL() << "they hold the same samples";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("has the seed 1 of"));
  }
  EXPECT_THROW(merge({files[0]}), Error);
}

}  // namespace
}  // namespace vernier::test
