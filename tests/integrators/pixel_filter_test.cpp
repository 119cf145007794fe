// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/pixel_filter.h"

#include <gmock/gmock.h>

#include <functional>
#include <numbers>

#include "core/base/parallel.h"
#include "integrators/render/render.h"
#include "scene/camera.h"
#include "tests/support/random.h"
#include "tests/support/test_scenes.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

/// Filters, and their weight at a part of their width from 0 to 1, up to a factor.
struct Case {
  const char* name;
  std::function<double(double)> weight;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"box", [](double) { return 1.0; }},
      {"box:2.5", [](double) { return 1.0; }},
      {"gaussian:3", [](double t) { return std::exp(-square(6 * (t - 0.5)) / 2); }},
      {"blackman-harris:1.5", [](double t) {
         const double angle = 2 * std::numbers::pi * t;
         return 0.35875 - 0.48829 * std::cos(angle) + 0.14128 * std::cos(2 * angle) -
                0.01168 * std::cos(3 * angle);
       }}};
  return all;
}

/// Weight between two parts of the width; that of the whole is 1.
double share(const Case& filter, double from, double to) {
  const auto integral = [&](double a, double b) {
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += filter.weight(a + (b - a) * (i + 0.5) / steps);
    return sum * (b - a) / steps;
  };
  return integral(from, to) / integral(0, 1);
}

TEST(PixelFilter, SamplesFollowTheFilter) {
  constexpr int cells = 24, samples = 100'000;
  for (const Case& filter : cases()) {
    const PixelFilter parsed = parse_filter(filter.name);
    const FilterSampler sampler(parsed);
    std::vector<double> expected(cells * cells);
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x)
        expected[size_t(y) * cells + size_t(x)] = samples *
                                                  share(filter, double(x) / cells, double(x + 1) / cells) *
                                                  share(filter, double(y) / cells, double(y + 1) / cells);
    EXPECT_TRUE(confirmed(sidak(1e-4, cases().size()), samples, [&](uint64_t seed, uint64_t count) {
      Random random(seed);
      std::vector<double> observed(cells * cells), scaled = expected;
      for (double& value : scaled) value *= double(count) / samples;
      for (uint64_t i = 0; i < count; ++i) {
        const Vec2f at = sampler.sample(random.next2());
        const auto cell = [&](float v) {
          const double part = (double(v) - 0.5) / parsed.width + 0.5;
          EXPECT_TRUE(part > -1e-6 && part < 1 + 1e-6) << filter.name << " " << v;
          return std::clamp(int(part * cells), 0, cells - 1);
        };
        ++observed[size_t(cell(at.y)) * cells + size_t(cell(at.x))];
      }
      return chi_square_p_value(observed, scaled);
    })) << filter.name;
  }
}

TEST(PixelFilter, KeepsTheOrderOfNumbersAndEndsInItsWidth) {
  for (const Case& filter : cases()) {
    const PixelFilter parsed = parse_filter(filter.name);
    const FilterSampler sampler(parsed);
    float last = -100;
    for (int i = 0; i <= 1000; ++i) {
      const float u = std::min(float(i) / 1000, 0x1.fffffep-1f);
      const float at = sampler.sample({u, 0.5f}).x;
      EXPECT_GT(at, last) << filter.name;
      EXPECT_LE(std::abs(at - 0.5f), parsed.width / 2 * (1 + 1e-6f)) << filter.name;
      last = at;
    }
  }
}

TEST(PixelFilter, TheBoxOfOnePixelTakesNumbersAsTheyAre) {
  const FilterSampler sampler(PixelFilter{});
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = random.next2();
    EXPECT_EQ(sampler.sample(u), u);
  }
}

Image picture(const Scene& scene, const CameraDescription& view, const RenderSettings& settings) {
  const Camera camera(view, settings.width, settings.height);
  const std::atomic<bool> stop = false;
  return render(scene, camera, *path({}), settings, stop).film.image();
}

// Right of the middle everything shines: a column shows the part of the filter that lies on that side.
TEST(PixelFilter, AnEdgeComesOutAsTheFiltersIntegral) {
  constexpr int width = 12, height = 8;
  const Scene scene =
      SceneBuilder().add(parallelogram({0, -99, 0}, {99, 0, 0}, {0, 198, 0}), emitter(1)).build();
  CameraDescription view;
  view.kind = CameraDescription::Kind::orthographic;
  view.ymag = float(height) / 2;  // one metre a pixel
  view.to_world.origin = {0, 0, 5};
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.limits.spp = 256;
  settings.adaptive = false;
  for (const auto& [name, cut] : {std::pair("gaussian:4", 2), {"blackman-harris:5", 3}, {"box:3", 1}}) {
    const Case& filter = cases()[size_t(cut)];
    settings.filter = parse_filter(name);
    const Image image = picture(scene, view, settings);
    for (int x = 0; x < width; ++x) {
      double mean = 0;
      for (int y = 0; y < height; ++y) mean += double(*image.pixel(x, y)) / height;
      const double edge = (width / 2.0 - (x + 0.5)) / settings.filter.width + 0.5;
      const double expected = edge >= 1 ? 0 : edge <= 0 ? 1 : share(filter, edge, 1);
      EXPECT_NEAR(mean, expected, 2e-3) << name << " column " << x;
    }
  }
}

// Nothing shines near the picture's ends, beyond which a filter sees what the box does not.
TEST(PixelFilter, KeepsThePicturesMean) {
  PunctualLightDescription lamp;
  lamp.intensity = 100;
  lamp.to_world.origin = {2, 3, 4};
  const Scene scene = SceneBuilder().add(sphere({0, 0, 0}, 1, 8, 16), plastic(0.3f)).add(lamp).build();
  CameraDescription view;
  view.yfov = 0.8f;
  view.to_world.origin = {0, 0, 5};
  RenderSettings settings;
  settings.width = settings.height = 20;
  settings.limits.spp = 16;
  const auto means_of = [&](const char* filter, uint64_t first_seed) {
    settings.filter = parse_filter(filter);
    Samples means;
    for (settings.seed = first_seed; settings.seed < first_seed + 12; ++settings.seed) {
      const Image image = picture(scene, view, settings);
      double sum = 0;
      for (const float value : image.values) sum += value;
      means.add(sum / double(image.values.size()));
    }
    return means;
  };
  const Samples box = means_of("box", 0);
  ASSERT_LT(detectable_bias(box.standard_error() * std::numbers::sqrt2, 1e-3) / box.mean(), 0.02);
  for (const char* filter : {"box:2", "gaussian:3", "blackman-harris:4"})
    EXPECT_GT(welch_p_value(box, means_of(filter, 100)), 1e-3) << filter;
}

TEST(PixelFilter, ACropIsAPartOfTheWholeForAnyNumberOfThreads) {
  const Scene scene = SceneBuilder().add(sphere({0, 0, 0}, 1, 6, 12), emitter(1)).build();
  CameraDescription view;
  view.yfov = 0.6f;
  view.lens_radius = 0.3f;
  view.focus_distance = 3;
  view.to_world.origin = {0, 0, 5};
  RenderSettings settings;
  settings.width = settings.height = 24;
  settings.limits.spp = 4;
  settings.filter = parse_filter("gaussian:3");
  const Image whole = picture(scene, view, settings);
  const ThreadLimit one(1);
  EXPECT_EQ(picture(scene, view, settings).values, whole.values);
  settings.crop = {5, 7, 11, 9};
  const Image part = picture(scene, view, settings);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x) EXPECT_EQ(rgb_at(part, x, y), rgb_at(whole, x + 5, y + 7));
}

TEST(PixelFilter, IsReadAsItIsWritten) {
  for (const char* text : {"box:1", "gaussian:2.5", "blackman-harris:1.5"})
    EXPECT_EQ(filter_text(parse_filter(text)), text);
  for (const FilterEntry& entry : filters())
    EXPECT_EQ(filter_text(parse_filter(entry.name)), filter_text({entry.kind, entry.width}));
  EXPECT_EQ(filter_text(parse_filter("Black:3")), "blackman-harris:3");
  const auto complaint = [](const char* text) -> std::string {
    try {
      parse_filter(text);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(complaint("gausian"), HasSubstr("did you mean 'gaussian'"));
  EXPECT_THAT(complaint("gaussian:wide"), HasSubstr("'wide' is not a filter's width"));
  for (const char* text : {"box:0", "box:17", "box:-1", "box:nan", "box:inf"})
    EXPECT_THAT(complaint(text), HasSubstr("expected 0.1 to 16")) << text;
  EXPECT_THAT(complaint("box:"), HasSubstr("width in pixels"));
}

// Light at any position gets to each pixel by the density with which the pixel's samples lie there: counted
// by cells of a tenth of a pixel.
TEST(PixelFilter, SharesAreOfTheDensityOfSamples) {
  constexpr int cells = 10, pixels = 6, samples = 200000, steps = 4000;
  for (const char* text : {"box", "box:0.5", "box:2.5", "gaussian:3", "blackman-harris"}) {
    const FilterSampler filter(parse_filter(text));
    std::vector<double> sampled(cells * pixels), shared(cells * pixels);
    // Of pixel 3, by the cell of the row that a sample lies in.
    for (int i = 0; i < samples; ++i) {
      const float at = 3 + filter.sample({(float(i) + 0.5f) / samples, 0.5f}).x;
      sampled[size_t(at * cells)] += 1. / samples;
    }
    for (int cell = 0; cell < cells * pixels; ++cell)
      for (int i = 0; i < steps; ++i) {
        // Positions within the cell, and a number that is even over them.
        constexpr int places = 40, numbers = steps / places;
        const int place = i % places, number = i / places;
        const float at = (float(cell) + (float(place) + 0.5f) / places) / cells;
        const auto share = filter.share(at, (float(number) + 0.5f) / float(numbers));
        if (share.pixel == 3) shared[size_t(cell)] += double(share.weight) / steps / cells;
      }
    for (size_t cell = 0; cell < sampled.size(); ++cell)
      EXPECT_NEAR(shared[cell], sampled[cell], 2e-3) << text << " " << cell;
  }
}

}  // namespace
}  // namespace vernier::test
