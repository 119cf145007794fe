// SPDX-License-Identifier: Apache-2.0
#include "core/display/display.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Every test starts without the user's $OCIO.
class Display : public testing::Test {
 protected:
  Display() { unsetenv("OCIO"); }
};

Image grey_image(const std::vector<float>& values) {
  Image image(int(values.size()), 1, 3);
  for (size_t x = 0; x < values.size(); ++x)
    for (int c = 0; c < 3; ++c) image.pixel(int(x), 0)[c] = values[x];
  return image;
}

std::vector<float> ramp(float from, float to, int count) {
  std::vector<float> values(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i)
    values[static_cast<size_t>(i)] = from + (to - from) * float(i) / float(count - 1);
  return values;
}

uint8_t round_byte(double value) { return uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255)); }

double srgb_encode(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::array<uint8_t, 3> bytes_at(const Image8& image, int x) {
  return {image.pixel(x, 0)[0], image.pixel(x, 0)[1], image.pixel(x, 0)[2]};
}

template <typename Action>
std::string error_of(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

TEST_F(Display, BuiltInViewsWithTheDefaultFirst) {
  EXPECT_THAT(display_views({}), ElementsAre("ACES SDR", "standard", "neutral", "AgX", "raw"));
}

TEST_F(Display, RawIsTheValueItself) {
  const Image8 shown = to_display(grey_image(ramp(0, 1, 256)), {.view = "raw"});
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(bytes_at(shown, i), (std::array<uint8_t, 3>{uint8_t(i), uint8_t(i), uint8_t(i)}));
}

TEST_F(Display, StandardIsTheSrgbTransferFunction) {
  const auto values = ramp(0, 1, 4096);
  const Image8 shown = to_display(grey_image(values), {.view = "standard"});
  for (int x = 0; x < shown.width; ++x) {
    const double exact = srgb_encode(values[x]) * 255;
    // A value within float rounding of a half may go either way.
    EXPECT_NEAR(shown.pixel(x, 0)[0], exact, 0.5 + 0.002) << values[x];
  }
}

TEST_F(Display, StandardKeepsSaturatedColours) {
  Image image(4, 1, 3);
  image.values = {1, 0, 0, 0, 0.5f, 0, 0, 0, 0.2f, 7, 0.3f, -1};
  const Image8 shown = to_display(image, {.view = "standard"});
  EXPECT_EQ(bytes_at(shown, 0), (std::array<uint8_t, 3>{255, 0, 0}));
  EXPECT_EQ(bytes_at(shown, 1), (std::array<uint8_t, 3>{0, round_byte(srgb_encode(0.5)), 0}));
  EXPECT_EQ(bytes_at(shown, 2), (std::array<uint8_t, 3>{0, 0, round_byte(srgb_encode(0.2))}));
  EXPECT_EQ(bytes_at(shown, 3), (std::array<uint8_t, 3>{255, round_byte(srgb_encode(0.3)), 0}));
}

TEST_F(Display, EightBitSrgbSurvivesTheRoundTrip) {
  std::vector<float> linear = ramp(0, 1, 256);
  for (float& value : linear) value = srgb_to_linear(value);
  const Image8 shown = to_display(grey_image(linear), {.view = "standard"});
  for (int i = 0; i < 256; ++i) EXPECT_EQ(shown.pixel(i, 0)[0], i);
}

// Written from the text of the specification in double, apart from the code under test.
std::array<double, 3> pbr_neutral(std::array<double, 3> colour) {
  const double low = *std::min_element(colour.begin(), colour.end());
  const double offset = low <= 0.08 ? low - low * low / (4 * 0.04) : 0.04;
  for (double& c : colour) c -= offset;
  const double peak = *std::max_element(colour.begin(), colour.end());
  const double start = 0.8 - 0.04;
  if (peak <= start) return colour;
  const double compressed = 1 - (1 - start) * (1 - start) / (peak + 1 - 2 * start);
  const double weight = 1 / (0.15 * (peak - compressed) + 1);
  for (double& c : colour) c = c * compressed / peak * weight + compressed * (1 - weight);
  return colour;
}

TEST_F(Display, NeutralIsTheKhronosFormula) {
  Image image(24 * 24 * 24, 1, 3);
  for (int i = 0; i < image.width; ++i)
    for (int c = 0; c < 3; ++c) {
      const int step = c == 0 ? i % 24 : c == 1 ? i / 24 % 24 : i / 576;
      image.pixel(i, 0)[c] = step == 0 ? 0 : std::exp2(float(step) / 2 - 7);
    }
  const Image8 shown = to_display(image, {.view = "neutral"});
  for (int i = 0; i < image.width; ++i) {
    const float* in = image.pixel(i, 0);
    const auto expected = pbr_neutral({in[0], in[1], in[2]});
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(shown.pixel(i, 0)[c], srgb_encode(expected[c]) * 255, 0.5 + 0.01)
          << in[0] << " " << in[1] << " " << in[2];
  }
}

TEST_F(Display, NeutralKeepsBaseColourAndCompressesHighlights) {
  // Under its F90 of 0.04 a neutral base colour b lit to b + 0.04 comes back as b, up to 0.8.
  const Image8 shown = to_display(grey_image({0.5f + 0.04f, 0.2f + 0.04f, 1e6f}), {.view = "neutral"});
  EXPECT_EQ(shown.pixel(0, 0)[0], round_byte(srgb_encode(0.5)));
  EXPECT_EQ(shown.pixel(1, 0)[0], round_byte(srgb_encode(0.2)));
  EXPECT_EQ(shown.pixel(2, 0)[0], 255);
}

// A polynomial that web viewers take for AgX's curve (Wrensch 2023, "Minimal AgX Implementation"), of greys,
// whose colour no matrix changes.
double agx_of_grey(double value) {
  const double x = std::clamp((std::log2(std::max(value, 1e-10)) + 12.47393) / 16.5, 0.0, 1.0);
  const double x2 = x * x, x4 = x2 * x2;
  const double y =
      15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 + 0.1191 * x - 0.00232;
  return std::pow(std::max(y, 0.0), 2.2);
}

TEST_F(Display, AgxOfGreysIsWhatOthersHave) {
  std::vector<float> values;
  values.reserve(300);
  for (int i = 0; i < 300; ++i) values.push_back(std::exp2(float(i) / 20 - 11));
  const Image8 shown = to_display(grey_image(values), {.view = "AgX"});
  for (int x = 0; x < shown.width; ++x) {
    const auto rgb = bytes_at(shown, x);
    EXPECT_NEAR(rgb[0], rgb[1], 1) << values[size_t(x)];
    EXPECT_NEAR(rgb[2], rgb[1], 1) << values[size_t(x)];
    EXPECT_NEAR(rgb[1], srgb_encode(agx_of_grey(values[size_t(x)])) * 255, 3) << values[size_t(x)];
    EXPECT_GE(rgb[1], shown.pixel(std::max(0, x - 1), 0)[1]) << values[size_t(x)];
  }
}

TEST_F(Display, AgxTakesTheColourOfBrightLight) {
  Image image(2, 1, 3);
  image.values = {0.1f, 0.01f, 0.01f, 50, 5, 5};
  const Image8 shown = to_display(image, {.view = "AgX"});
  const auto dim = bytes_at(shown, 0), bright = bytes_at(shown, 1);
  EXPECT_GT(dim[0], 1.5 * dim[1]);
  EXPECT_LT(bright[0], 1.2 * bright[1]);
}

TEST_F(Display, AcesIsMonotoneNeutralAndPlausible) {
  std::vector<float> values{0};
  for (int i = 0; i < 600; ++i) values.push_back(std::exp2(float(i) / 30 - 12));
  const Image8 shown = to_display(grey_image(values), {});
  for (int x = 0; x < shown.width; ++x) {
    const auto rgb = bytes_at(shown, x);
    EXPECT_NEAR(rgb[0], rgb[1], 1) << values[x];
    EXPECT_NEAR(rgb[2], rgb[1], 1) << values[x];
    EXPECT_GE(rgb[1], shown.pixel(std::max(0, x - 1), 0)[1]) << values[x];
  }
  EXPECT_EQ(shown.pixel(0, 0)[1], 0);
  EXPECT_EQ(shown.pixel(shown.width - 1, 0)[1], 255);
  // ACES 1.x shows 18 % grey at a tenth of its white's luminance (RRT and ODT mid point 4.8 of 48 nits).
  const Image8 grey = to_display(grey_image({0.18f}), {});
  EXPECT_NEAR(grey.pixel(0, 0)[1], srgb_encode(0.1) * 255, 2);
}

TEST_F(Display, ExposureIsInStops) {
  const auto values = ramp(0, 0.2f, 100);
  auto doubled = values;
  for (float& value : doubled) value *= 4;
  for (const char* view : {"ACES SDR", "standard", "neutral", "AgX", "raw"})
    EXPECT_EQ(to_display(grey_image(values), {.view = view, .exposure = 2}).values,
              to_display(grey_image(doubled), {.view = view}).values);
}

TEST_F(Display, NotFiniteValuesAreSafe) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::nanf(""), big = 3e38f;
  Image image(5, 1, 3);
  image.values = {nan, nan, nan, inf, inf, inf, -inf, -inf, -inf, big, big, big, inf, nan, -inf};
  for (const char* view : {"ACES SDR", "standard", "neutral", "AgX", "raw"}) {
    SCOPED_TRACE(view);
    const Image8 shown = to_display(image, {.view = view, .exposure = 10});
    EXPECT_EQ(bytes_at(shown, 0), (std::array<uint8_t, 3>{0, 0, 0}));
    EXPECT_EQ(bytes_at(shown, 1), (std::array<uint8_t, 3>{255, 255, 255}));
    EXPECT_EQ(bytes_at(shown, 2), (std::array<uint8_t, 3>{0, 0, 0}));
    EXPECT_EQ(bytes_at(shown, 3), (std::array<uint8_t, 3>{255, 255, 255}));
    EXPECT_EQ(shown.pixel(4, 0)[0], 255);
  }
}

TEST_F(Display, UnknownViewListsTheViews) {
  EXPECT_THAT(error_of(ErrorKind::usage, [] { to_display(grey_image({0}), {.view = "standart"}); }),
              testing::AllOf(HasSubstr("did you mean 'standard'"),
                             HasSubstr("ACES SDR, standard, neutral, AgX, raw")));
}

// A config whose reference is `reference` and whose only view halves the values it is given in that
// reference.
std::string user_config(const std::string& roles, const std::string& spaces) {
  return "ocio_profile_version: 2\nsearch_path: \"\"\nstrictparsing: true\nroles:\n" + roles +
         "file_rules:\n  - !<Rule> {name: Default, colorspace: reference}\n"
         "displays:\n  monitor:\n    - !<View> {name: half, colorspace: half}\n"
         "    - !<View> {name: same, colorspace: reference}\n"
         "colorspaces:\n"
         "  - !<ColorSpace>\n    name: reference\n"
         "  - !<ColorSpace>\n    name: half\n"
         "    from_scene_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, "
         "0, 0, 0, 1]}\n" +
         spaces;
}

TEST_F(Display, UserConfigHasItsOwnViews) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("c.ocio", user_config("  scene_linear: reference\n", ""));
  EXPECT_THAT(display_views({.config = file}), ElementsAre("half", "same"));
  EXPECT_EQ(to_display(grey_image({0.4f}), {.config = file}).pixel(0, 0)[0], 51);
  EXPECT_EQ(to_display(grey_image({0.4f}), {.view = "same", .config = file}).pixel(0, 0)[0], 102);
}

TEST_F(Display, EnvironmentNamesTheConfigUnlessTheOptionDoes) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("c.ocio", user_config("  scene_linear: reference\n", ""));
  setenv("OCIO", file.c_str(), 1);
  EXPECT_THAT(display_views({}), ElementsAre("half", "same"));
  setenv("OCIO", "/nonexistent.ocio", 1);
  EXPECT_THAT(display_views({.config = file}), ElementsAre("half", "same"));
  EXPECT_THAT(error_of(ErrorKind::input, [] { display_views({}); }), HasSubstr("/nonexistent.ocio"));
  setenv("OCIO", "", 1);
  EXPECT_THAT(display_views({}), testing::Contains("neutral"));
  unsetenv("OCIO");
}

TEST_F(Display, LinearRec709IsFoundByInterchangeRole) {
  const test::TemporaryFolder folder;
  // The reference is ACES2065-1: pure Rec.709 red is (0.4396, 0.0898, 0.0175) in it.
  const std::string file = folder.write("c.ocio", user_config("  aces_interchange: reference\n", ""));
  Image red(1, 1, 3);
  red.values = {1, 0, 0};
  EXPECT_EQ(bytes_at(to_display(red, {.view = "same", .config = file}), 0),
            (std::array<uint8_t, 3>{112, 23, 4}));
}

TEST_F(Display, LinearRec709IsFoundByName) {
  const test::TemporaryFolder folder;
  const std::string named =
      "  - !<ColorSpace>\n    name: Linear Rec.709 (sRGB)\n"
      "    to_scene_reference: !<MatrixTransform> {matrix: [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, "
      "1]}\n";
  const std::string file = folder.write("c.ocio", user_config("  scene_linear: reference\n", named));
  Image red(1, 1, 3);
  red.values = {1, 0, 0};
  EXPECT_EQ(bytes_at(to_display(red, {.view = "same", .config = file}), 0),
            (std::array<uint8_t, 3>{0, 255, 0}));
}

TEST_F(Display, UnusableConfigsAreInputErrors) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(error_of(ErrorKind::input, [] { to_display(grey_image({0}), {.config = "/none.ocio"}); }),
              HasSubstr("/none.ocio"));
  const std::string text = folder.write("c.ocio", "this is not a config");
  EXPECT_THAT(error_of(ErrorKind::input, [&] { display_views({.config = text}); }), HasSubstr("c.ocio"));
  const std::string no_role = folder.write("d.ocio", user_config("  data: reference\n", ""));
  EXPECT_THAT(error_of(ErrorKind::input, [&] { to_display(grey_image({0}), {.config = no_role}); }),
              HasSubstr("aces_interchange or scene_linear"));
}

TEST_F(Display, PictureIsNotMixedUpBetweenRows) {
  Image image(33, 57, 3);
  for (int y = 0; y < 57; ++y)
    for (int x = 0; x < 33; ++x)
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = float((x * 7 + y * 5 + c * 11) % 256) / 255;
  const Image8 shown = to_display(image, {.view = "raw"});
  for (int y = 0; y < 57; ++y)
    for (int x = 0; x < 33; ++x)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(shown.pixel(x, y)[c], (x * 7 + y * 5 + c * 11) % 256);
}

}  // namespace
}  // namespace vernier
