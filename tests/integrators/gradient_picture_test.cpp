// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>
#include <map>

#include "integrators/render/render_state.h"
#include "tests/support/effort.h"
#include "tests/support/random_scenes.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/picture.h"
#include "vernier/session.h"

// Pictures that are reconstructed from differences between pixels.

namespace vernier::test {
namespace {

using testing::HasSubstr;

std::shared_ptr<const Scene> built(SceneDescription description, const std::string& hash) {
  description.hash = hash;
  return build_scene(std::move(description));
}

/// A room with a lamp, a small mirror and a glass ball under a point lamp: differences, light paths and
/// chains.
std::shared_ptr<const Scene> room() {
  SceneBuilder scene;
  scene.add(box({-1, 0, -1}, {1, 2, 1}, true), diffuse(0.6f))
      .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
      .add(box({-0.7f, 0, -0.6f}, {-0.2f, 0.8f, -0.1f}), plastic(0.3f))
      .add(parallelogram({0.1f, 0.1f, -0.9f}, {0.8f, 0, 0}, {0, 0.9f, 0}), metal(0))
      .add(smooth_sphere({0.35f, 0.4f, 0}, 0.2f, 12, 24), glass(0))
      .add(point_lamp({0.3f, 1.5f, 0.2f}, 1));
  return built(scene.description(), "room");
}

/// The first random scene without a medium that scatters light.
std::shared_ptr<const Scene> clear_scene() {
  for (uint64_t seed = 1;; ++seed) {
    auto scene = built(random_scene(seed).description, "random scene " + std::to_string(seed));
    if (!scene->volumes().scatter()) return scene;
  }
}

/// A block that falls before a lit wall while the shutter is open.
std::shared_ptr<const Scene> moving_scene() {
  MeshDescription block = box({-0.4f, 0.8f, -0.5f}, {0.2f, 1.4f, 0});
  for (const float part : {-1.f, 1.f}) {
    MeshShape shape;
    for (const Vec3f& at : block.positions) shape.positions.push_back(at - Vec3f(0, 0.4f * part, 0));
    block.moments.push_back(shape);
  }
  SceneBuilder scene;
  scene.add(box({-1, 0, -1}, {1, 2, 1}, true), diffuse(0.6f))
      .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
      .add(block, diffuse(0.5f));
  return built(scene.description(), "moving");
}

RenderSettings settings_of_room(int spp) {
  RenderSettings settings;
  settings.width = 24;
  settings.height = 16;
  settings.camera.yfov = 1.2f;
  settings.camera.to_world.origin = {0, 1, 0.95f};
  settings.integrator = "gradient";
  settings.limits.spp = spp;
  return settings;
}

Vec3d mean_of_halves(const Film& film, int x, int y) {
  return (film.half_mean(x, y, 0) + film.half_mean(x, y, 1)) / 2.0;
}

/// What the reconstruction adds to the samples' mean and what light paths bring.
Vec3d correction(const Film& film, int x, int y) {
  const Vec3d unchanged = film.sample_mean(x, y, 0) + film.sample_mean(x, y, 1) + film.splat_mean(x, y, 0) +
                          film.splat_mean(x, y, 1);
  return mean_of_halves(film, x, y) - unchanged / 2.0;
}

/// The least of the p-values for each 4 x 4 block and each pixel of the border that what is added is zero in
/// the mean over renders, and how many there are.
std::pair<double, size_t> p_value_of_corrections(const std::shared_ptr<const Scene>& scene,
                                                 RenderSettings settings, int renders) {
  std::map<std::pair<int, int>, std::array<Samples, 3>> places;
  for (int i = 0; i < renders; ++i) {
    ++settings.seed;
    RenderSession session(scene, settings);
    session.run();
    const Film& film = session.result().film;
    std::map<std::pair<int, int>, Vec3d> sums;
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) {
        const Vec3d added = correction(film, x, y);
        sums.try_emplace({x / 4, y / 4}, 0).first->second += added;
        if (x == 0 || y == 0 || x + 1 == film.width() || y + 1 == film.height()) sums[{100 + x, y}] = added;
      }
    for (const auto& [place, sum] : sums)
      for (int c = 0; c < 3; ++c) places[place][size_t(c)].add(sum[c]);
  }
  double p = 1;
  for (const auto& [place, channels] : places)
    for (const Samples& channel : channels)
      if (channel.variance() > 1e-12) p = std::min(p, mean_p_value(channel, 0));
  return {p, 3 * places.size()};
}

// The samples have the right mean, as those of `path`; so what is added to them must be zero in the mean,
// in areas and at the borders of the picture, that of a crop too.
TEST(GradientPicture, ReconstructionIsUnbiased) {
  RenderSettings plain = settings_of_room(20);
  plain.width = 16;
  plain.height = 12;
  plain.integrator_options.caustics = Caustics::off;
  RenderSettings cropped = plain, rolling = plain, random = plain;
  cropped.width = 28;
  cropped.height = 24;
  cropped.crop = {7, 5, 14, 12};
  cropped.adaptive = false;
  rolling.row_exposure = 0.5f;
  const auto scene = clear_scene();
  random.camera = fitted_camera(*scene, 4 / 3.f);
  struct Case {
    const char* name;
    std::shared_ptr<const Scene> scene;
    RenderSettings settings;
  };
  const std::vector<Case> cases{{"room", room(), plain},
                                {"crop", room(), cropped},
                                {"moving", moving_scene(), rolling},
                                {"random", scene, random}};
  for (const Case& c : cases) {
    double p = 1;
    EXPECT_TRUE(confirmed(1e-4, 16,
                          [&](uint64_t run, uint64_t renders) {
                            RenderSettings settings = c.settings;
                            settings.seed = 1000 * run;
                            const auto [smallest, tests] = p_value_of_corrections(
                                c.scene, settings, std::max(8, int(renders) / thinning));
                            return p = 1 - std::pow(1 - smallest, double(tests));
                          }))
        << c.name << ": p " << p;
  }
}

// In a closed room whose walls all glow and reflect alike, radiance is a geometric series (a white furnace
// with loss).
TEST(GradientPicture, FurnaceIsAsBrightAsItsSeries) {
  MaterialDescription wall = diffuse(0.5f);
  wall.emissive = {0.4f, 0.4f, 0.4f};
  const auto scene =
      built(SceneBuilder().add(box({-1, 0, -1}, {1, 2, 1}, true), wall).description(), "furnace");
  RenderSettings settings = settings_of_room(16);
  settings.integrator_options.max_depth = 12;
  double expected = 0;
  for (int bounces = 0; bounces < 12; ++bounces) expected += 0.4 * std::pow(0.5, bounces);
  Samples whole, corner;
  for (int i = 0; i < 12; ++i) {
    ++settings.seed;
    RenderSession session(scene, settings);
    session.run();
    const Film& film = session.result().film;
    double sum = 0;
    for (int y = 0; y < film.height(); ++y)
      for (int x = 0; x < film.width(); ++x) sum += film.pixel(x, y).x;
    whole.add(sum / (film.width() * film.height()));
    corner.add(film.pixel(0, 0).x);
  }
  EXPECT_GT(mean_p_value(whole, expected), 1e-3) << whole.mean() << " of " << expected;
  EXPECT_GT(mean_p_value(corner, expected), 1e-3) << corner.mean() << " of " << expected;
  EXPECT_LT(whole.standard_error(), 1e-3);
}

// The samples are those of the integrator path, whatever light there is; only what is made of them is better.
TEST(GradientPicture, SamplesAreThoseOfPath) {
  RenderSettings settings = settings_of_room(16);
  settings.adaptive = false;
  const auto scene = room();
  RenderSession gradient(scene, settings);
  gradient.run();
  settings.integrator = "path";
  RenderSession path(scene, settings);
  path.run();
  const Film &a = gradient.result().film, &b = path.result().film;
  ASSERT_TRUE(a.has_splats());
  for (int y = 0; y < a.height(); ++y)
    for (int x = 0; x < a.width(); ++x)
      for (int half = 0; half < Film::halves; ++half) {
        EXPECT_EQ(a.splat_mean(x, y, half), b.splat_mean(x, y, half));
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(a.sample_mean(x, y, half)[c], b.sample_mean(x, y, half)[c],
                      1e-4 * (0.01 + b.sample_mean(x, y, half)[c]));
      }
  const MissingEstimate &missing = gradient.result().missing, &of_path = path.result().missing;
  EXPECT_NEAR(missing.bent.share, of_path.bent.share, 1e-4);
  EXPECT_NEAR(missing.depth.share, of_path.depth.share, 1e-4);
}

// Less noise is what it is for.
TEST(GradientPicture, HasLessErrorThanItsSamples) {
  RenderSettings settings = settings_of_room(32);
  settings.integrator_options.caustics = Caustics::off;
  RenderSession gradient(room(), settings);
  gradient.run();
  settings.integrator = "path";
  RenderSession path(room(), settings);
  path.run();
  EXPECT_LT(gradient.status().error.rel_rmse, 0.75 * path.status().error.rel_rmse);
}

// A render that was saved in a file and gone on with makes the picture of one that never stopped.
TEST(GradientPicture, GoesOnFromAFile) {
  const TemporaryFolder folder;
  const auto scene = room();
  for (const bool adaptive : {true, false}) {
    RenderSettings settings = settings_of_room(32);
    settings.width = 18;
    settings.height = 17;
    settings.adaptive = adaptive;
    RenderSession whole(scene, settings);
    whole.run();
    settings.limits.spp = 21;
    RenderSession first(scene, settings);
    first.run();
    first.save(folder.file("a.ckpt"));
    EXPECT_NE(first.picture().image.values, whole.picture().image.values);
    settings.limits.spp = 32;
    RenderSession second(scene, settings);
    second.load(folder.file("a.ckpt"));
    EXPECT_EQ(second.picture().image.values, first.picture().image.values);
    EXPECT_EQ(second.status().error.rel_rmse, first.status().error.rel_rmse);
    second.run();
    EXPECT_EQ(second.picture().image.values, whole.picture().image.values);
    EXPECT_EQ(second.status().error.rel_rmse, whole.status().error.rel_rmse);
  }
}

// What is counted of memory is what a checkpoint holds of a state.
TEST(GradientPicture, BytesPerPixelAreThoseOfTheState) {
  const TemporaryFolder folder;
  const RenderSettings settings = settings_of_room(17);
  RenderSession session(room(), settings);
  session.run();
  session.save(folder.file("a.ckpt"));
  const auto stored = double(std::filesystem::file_size(folder.file("a.ckpt")));
  const double expected =
      double(RenderState::bytes_per_pixel(true, false, 0, true, true)) * settings.width * settings.height;
  EXPECT_GT(stored, expected);
  EXPECT_LT(stored, expected + 4000);  // header, parts and looks
}

// With as many samples each, the picture of two merged renders is the mean of theirs.
TEST(GradientPicture, OfSeveralSeedsIsMerged) {
  const TemporaryFolder folder;
  const auto scene = room();
  RenderSettings settings = settings_of_room(16);
  settings.adaptive = false;
  std::vector<std::string> files;
  std::vector<Image> pictures;
  for (const uint64_t seed : {1, 2}) {
    settings.seed = seed;
    RenderSession session(scene, settings);
    session.run();
    pictures.push_back(session.picture().image);
    files.push_back(folder.file(std::to_string(seed)));
    session.save(files.back());
  }
  const MergedRender merged = merge(files);
  const Image& image = merged.picture.image;
  for (size_t i = 0; i < image.values.size(); ++i)
    EXPECT_NEAR(image.values[i], (pictures[0].values[i] + pictures[1].values[i]) / 2,
                1e-4 * (0.1 + double(image.values[i])));
  EXPECT_EQ(merged.picture.metadata.at("vernier:reconstruction"), "gradient-domain");
}

// Errors of neighbors add up, not their squares, so the same difference of two pictures says less.
TEST(GradientPicture, IsComparedAsOneWhoseNeighborsErrTogether) {
  RenderSettings settings = settings_of_room(24);
  std::vector<LayeredImage> pictures;
  for (const uint64_t seed : {1, 2}) {
    settings.seed = seed;
    RenderSession session(room(), settings);
    session.run();
    pictures.push_back(session.picture("error"));
  }
  const double p = compare(pictures[0], pictures[1]).at("mean_p");
  for (LayeredImage& picture : pictures) picture.metadata.erase("vernier:reconstruction");
  EXPECT_GT(p, compare(pictures[0], pictures[1]).at("mean_p"));
}

TEST(GradientPicture, RefusesWhatItCannotDo) {
  const auto expect_refused = [&](const std::shared_ptr<const Scene>& what, const auto& change,
                                  const std::string& why) {
    RenderSettings settings = settings_of_room(4);
    change(settings);
    try {
      RenderSession session(what, settings);
      ADD_FAILURE() << "not refused: " << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage);
      EXPECT_THAT(error.what(), HasSubstr(why));
      EXPECT_THAT(error.what(), HasSubstr("path"));
    }
  };
  const auto scene = room();
  expect_refused(
      scene, [](auto& s) { s.background.kind = Background::Kind::transparent; }, "behind");
  expect_refused(
      scene, [](auto& s) { s.integrator_options.light_sampling = LightSampling::light; }, "alone");
  expect_refused(
      scene, [](auto& s) { s.light_split.ways = {"emission"}; }, "apart");
  expect_refused(
      scene, [](auto& s) { s.texture_filter.kind = TextureFilter::Kind::mip; }, "textures");
  for (uint64_t seed = 1;; ++seed) {
    const auto foggy = build_scene(random_scene(seed).description);
    if (!foggy->volumes().scatter()) continue;
    expect_refused(
        foggy, [](auto&) {}, "medium");
    break;
  }
}

}  // namespace
}  // namespace vernier::test
