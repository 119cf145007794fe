// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/texture_filter.h"

#include <gmock/gmock.h>

#include <numbers>

#include "core/base/parallel.h"
#include "integrators/render/settings_identity.h"
#include "scene/camera.h"
#include "tests/support/pictures.h"
#include "vernier/error.h"
#include "vernier/session.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

constexpr int width = 48, height = 32;

TextureUse repeated(float times) {
  TextureUse use;
  use.texture = 0;
  use.scale = {times, times};
  return use;
}

/// A checker of single texels, `times` of it along each side of what has it.
SceneDescription with_checker(SceneDescription description, bool has_mips = true) {
  constexpr int size = 64;
  auto image = std::make_shared<Image8>(size, size, 1);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) *image->pixel(x, y) = (x + y) % 2 ? 255 : 0;
  description.textures.emplace_back(std::shared_ptr<const Image8>(image), WrapMode::repeat, WrapMode::repeat,
                                    FilterMode::linear, has_mips);
  return description;
}
/// What its eight bits make of the mean of black and white.
const float checker_mean = srgb_to_linear(188 / 255.f);

MaterialDescription glowing(const TextureUse& use) {
  MaterialDescription material = emitter(1);
  material.emissive_texture = use;
  return material;
}

MaterialDescription painted(const TextureUse& use) {
  MaterialDescription material = diffuse(1);
  material.base_color_texture = use;
  return material;
}

MeshDescription ground() { return parallelogram({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}); }

CameraDescription over_ground() { return camera_at({0, 12, 20}, {0, 0, -6}, 0.35f); }

RenderSettings settings_of(const char* filter, int spp = 1) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.adaptive = false;
  settings.limits.spp = spp;
  settings.texture_filter = parse_texture_filter(filter);
  settings.camera = over_ground();
  return settings;
}

Film film_of(const Scene& scene, const RenderSettings& settings) {
  const std::atomic<bool> stop = false;
  const auto integrator = make_integrator(settings.integrator, settings.integrator_options);
  return render(scene, Camera(settings.camera, settings.width, settings.height), *integrator, settings, stop)
      .film;
}
std::vector<float> picture_of(const Scene& scene, const RenderSettings& settings) {
  return film_of(scene, settings).image().values;
}

Samples values_of(const std::vector<float>& picture) {
  Samples samples;
  for (size_t i = 0; i < picture.size(); i += 3) samples.add(picture[i]);
  return samples;
}

/// A checker whose squares no pixel can tell apart is grey at a single sample a pixel, and noise without.
TEST(TextureFilter, ShowsTheMeanOfWhatIsFarBelowAPixel) {
  const SceneDescription lit_by_itself =
      with_checker(SceneBuilder().add(ground(), glowing(repeated(300))).description());
  const SceneDescription lit = with_checker(
      SceneBuilder().add(ground(), painted(repeated(300))).add(sun({0, -1, 0}, pi)).description());
  for (const auto& [description, integrator] :
       {std::pair(lit_by_itself, "path"), {lit_by_itself, "whitted"}, {lit, "path"}, {lit, "raycast"}}) {
    const Scene scene(description, {});
    RenderSettings settings = settings_of("mip");
    settings.integrator = integrator;
    settings.integrator_options.show = "albedo";
    const Samples filtered = values_of(picture_of(scene, settings));
    EXPECT_NEAR(filtered.mean(), checker_mean, 1e-3) << integrator;
    EXPECT_LT(std::sqrt(filtered.variance()), 1e-3) << integrator;
    settings.texture_filter = {};
    const Samples noisy = values_of(picture_of(scene, settings));
    // Of the product of two triangle waves.
    EXPECT_NEAR(std::sqrt(noisy.variance()), 1.0 / 6, 0.01) << integrator;
  }
}

/// A mirror shows textures as the camera does, a rough one as if nobody had asked.
TEST(TextureFilter, GoesOnByMirrorsAndNoFurther) {
  const auto scene_with = [](const MaterialDescription& mirror) {
    return with_checker(
        SceneBuilder()
            .add(parallelogram({-50, -50, -20}, {100, 0, 0}, {0, 100, 0}), mirror)
            .add(parallelogram({-200, -200, 30}, {0, 400, 0}, {400, 0, 0}), glowing(repeated(900)))
            .description());
  };
  RenderSettings settings = settings_of("mip");
  settings.camera = camera_at({0, 0, 0}, {0, 0.1f, -20}, 0.4f);
  const Samples seen = values_of(picture_of(Scene(scene_with(metal(0)), {}), settings));
  EXPECT_NEAR(seen.mean(), checker_mean, 2e-3);
  EXPECT_LT(std::sqrt(seen.variance()), 2e-3);
  const Scene rough(scene_with(metal(0.5f)), {});
  const auto filtered = picture_of(rough, settings);
  settings.texture_filter = {};
  EXPECT_EQ(filtered, picture_of(rough, settings));
}

/// Stripes of light that vary as a sine, `wavelength` pixels long in a picture that faces them.
SceneDescription stripes(float wavelength) {
  constexpr int size = 512;
  const float waves = width / wavelength;
  auto image = std::make_shared<Image16>(size, 1, 1);
  for (int x = 0; x < size; ++x)
    image->values[size_t(x)] = uint16_t(std::lround(
        65535 * linear_to_srgb(0.5f + 0.5f * std::sin(2 * pi * waves * (float(x) + 0.5f) / size))));
  SceneDescription description =
      SceneBuilder()
          .add(parallelogram({-3, -2, 0}, {6, 0, 0}, {0, 4, 0}), glowing(repeated(1)))
          .description();
  description.textures.emplace_back(std::shared_ptr<const Image16>(image), WrapMode::repeat, WrapMode::repeat,
                                    FilterMode::linear);
  return description;
}

/// Contrast of such stripes in a picture, 1 at full.
double contrast(const std::vector<float>& picture, float wavelength) {
  double sine = 0;
  for (size_t i = 0; i < picture.size(); i += 3)
    sine += picture[i] * std::sin(2 * std::numbers::pi * (double(i / 3 % width) + 0.5) / wavelength);
  return 4 * sine / (width * height);
}

/// Stripes lose by a filter's variance v as much as exp(-(2 pi / wavelength)^2 v / 2), near enough where they
/// lose little: a box that is w pixels wide has w^2 / 12. What is filtered away falls as more samples are
/// taken, whose areas are an n-th of a pixel each, to the mean of these.
TEST(TextureFilter, BlursByItsAreaAndLessWithEverySample) {
  constexpr float wavelength = 8;
  const Scene scene(stripes(wavelength), {});
  RenderSettings settings = settings_of("none");
  settings.camera = {};
  settings.camera.kind = CameraDescription::Kind::orthographic;
  settings.camera.xmag = 3, settings.camera.ymag = 2;
  settings.camera.to_world.origin = {0, 0, 5};
  for (const int spp : {1, 2, 16, 128})
    for (const float size : {1.f, 2.f}) {
      double variance = 0;
      const int half = (spp + 1) / 2;
      for (int i = 0; i < half; ++i) variance += square(size) / (12 * (2 * i + 1.0) * half);
      Samples loss;
      for (uint64_t seed = 1; seed <= 24; ++seed) {
        settings.seed = seed;
        settings.limits.spp = spp;
        settings.texture_filter = {TextureFilter::Kind::mip, size};
        const double filtered = contrast(picture_of(scene, settings), wavelength);
        settings.texture_filter = {};
        loss.add(1 - filtered / contrast(picture_of(scene, settings), wavelength));
      }
      const double expected = 1 - std::exp(-square(2 * std::numbers::pi / wavelength) * variance / 2);
      EXPECT_NEAR(loss.mean(), expected, 0.06 * expected + 4 * loss.standard_error())
          << spp << " samples, " << size << " pixels";
      EXPECT_LT(loss.standard_error(), 0.1 * expected + 1e-4);
    }
}

TEST(TextureFilter, LeavesWhatIsNoColorAlone) {
  MaterialDescription rough = metal(1);
  rough.metallic_roughness_texture = repeated(30);
  rough.clearcoat = 1;
  rough.clearcoat_roughness = 0.3f;
  rough.clearcoat_normal_texture = rough.normal_texture = rough.clearcoat_texture = repeated(30);
  MaterialDescription clear = plastic(0.2f);
  clear.specular_texture = clear.transmission_texture = repeated(30);
  clear.transmission = 0.5f;
  for (const MaterialDescription& material : {rough, clear}) {
    const Scene scene(with_checker(SceneBuilder()
                                       .add(ground(), material)
                                       .environment([](const Vec3f& d) { return 1 + d.x; })
                                       .description()),
                      {});
    EXPECT_EQ(picture_of(scene, settings_of("mip", 4)), picture_of(scene, settings_of("none", 4)));
  }
}

/// What is cut out stays as large as it is, and what is left does not take on the color of holes.
TEST(TextureFilter, LeavesCoverageAlone) {
  constexpr int size = 32;
  auto image = std::make_shared<Image8>(size, size, 4);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool is_hole = (x / 2 + y / 2) % 2;
      for (int c = 0; c < 3; ++c) image->pixel(x, y)[c] = is_hole ? 0 : 255;
      image->pixel(x, y)[3] = is_hole ? 0 : 255;
    }
  for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
    MaterialDescription material = painted(repeated(100));
    material.alpha_mode = mode;
    material.unlit = true;
    SceneDescription description = SceneBuilder().add(ground(), material).description();
    description.textures.emplace_back(std::shared_ptr<const Image8>(image), WrapMode::repeat,
                                      WrapMode::repeat, FilterMode::nearest);
    const Scene scene(std::move(description), {});
    const auto filtered = picture_of(scene, settings_of("mip")),
               exact = picture_of(scene, settings_of("none"));
    for (size_t i = 0; i < exact.size(); ++i) EXPECT_NEAR(filtered[i], exact[i], 1e-3f);
    EXPECT_GT(values_of(exact).variance(), 0.1) << "holes and none";
  }
}

TEST(TextureFilter, LeavesTexturesThatWantNoMipsAlone) {
  const Scene scene(with_checker(SceneBuilder().add(ground(), glowing(repeated(300))).description(), false),
                    {});
  EXPECT_EQ(picture_of(scene, settings_of("mip")), picture_of(scene, settings_of("none")));
  EXPECT_EQ(scene.color_mips().bytes(), 0u);
}

TEST(TextureFilter, GivesTheSameBytesForAnyNumberOfThreads) {
  const SceneDescription description = with_checker(SceneBuilder()
                                                        .add(ground(), painted(repeated(40)))
                                                        .environment([](const Vec3f&) { return 1.f; })
                                                        .description());
  std::vector<std::vector<float>> pictures;
  for (const unsigned threads : {1u, 4u}) {
    const ThreadLimit limit(threads);
    pictures.push_back(picture_of(Scene(description, {}), settings_of("mip", 6)));
  }
  EXPECT_EQ(pictures[0], pictures[1]);
  const auto other = picture_of(Scene(description, {"bvh"}), settings_of("mip", 6));
  for (size_t i = 0; i < other.size(); ++i) EXPECT_NEAR(other[i], pictures[0][i], 2e-3f) << i;
}

/// Many renders of one scene may begin at once, also within a loop of theirs.
TEST(TextureFilter, PreparesASceneOnceForAll) {
  const Scene scene(with_checker(SceneBuilder().add(ground(), glowing(repeated(40))).description()), {});
  EXPECT_EQ(scene.color_mips().bytes(), 0u) << "nobody has asked";
  std::vector<std::vector<float>> pictures(32);
  parallel_for(pictures.size(), [&](size_t i) { pictures[i] = picture_of(scene, settings_of("mip")); });
  for (const auto& picture : pictures) EXPECT_EQ(picture, pictures[0]);
  EXPECT_EQ(scene.color_mips().bytes(), 32u * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1);
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "";
}

TEST(TextureFilter, IsReadAndWritten) {
  EXPECT_FALSE(parse_texture_filter("none").is_on());
  EXPECT_EQ(parse_texture_filter("mip").width, 1);
  EXPECT_EQ(parse_texture_filter("mip:0.5").width, 0.5f);
  for (const char* text : {"none", "mip:1", "mip:0.25"})
    EXPECT_EQ(texture_filter_text(parse_texture_filter(text)), text);
  for (const char* text : {"mip:", "mip:x", "mip:1x", "none:1", "mip:1:2"})
    EXPECT_THAT(refusal([&] { parse_texture_filter(text); }), HasSubstr("expected none, mip, or mip with"))
        << text;
  for (const char* text : {"mip:0", "mip:-1", "mip:17", "mip:nan", "mip:inf"})
    EXPECT_THAT(refusal([&] { parse_texture_filter(text); }), HasSubstr("expected 0.1 to 16")) << text;
  for (const char* text : {"", "mipp", "linear"})
    EXPECT_THAT(refusal([&] { parse_texture_filter(text); }), HasSubstr("unknown --texture-filter")) << text;
}

TEST(TextureFilter, IsPartOfWhatSamplesDependOn) {
  const RenderSettings none = settings_of("none"), mip = settings_of("mip"), half = settings_of("mip:0.5");
  EXPECT_NE(identity_of(none), identity_of(mip));
  EXPECT_NE(identity_of(half), identity_of(mip));
  for (const RenderSettings& settings : {none, mip, half}) {
    const RenderSettings again = RenderSettings::from_json(settings.to_json());
    EXPECT_EQ(identity_of(again), identity_of(settings));
    EXPECT_EQ(again.texture_filter.width, settings.texture_filter.width);
  }
}

TEST(TextureFilter, ThatThereCannotBeIsRefused) {
  const auto scene =
      build_scene(with_checker(SceneBuilder().add(ground(), glowing(repeated(40))).description()));
  RenderSettings settings = settings_of("mip");
  EXPECT_EQ(refusal([&] { RenderSession(scene, settings); }), "");
  settings.texture_filter.width = 0;
  EXPECT_THAT(refusal([&] { RenderSession(scene, settings); }), HasSubstr("an area 0 pixels wide"));
  settings = settings_of("mip");
  settings.integrator = "light";
  EXPECT_THAT(refusal([&] { RenderSession(scene, settings); }), HasSubstr("reads textures at points"));
  settings.texture_filter = {};
  EXPECT_EQ(refusal([&] { RenderSession(scene, settings); }), "");
}

}  // namespace
}  // namespace vernier::test
