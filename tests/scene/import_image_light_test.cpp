// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "scene/lights/environment.h"
#include "tests/scene/import_support.h"
#include "tests/support/png_bytes.h"

// EXT_lights_image_based: which way faces look, how they are turned, and what their numbers mean.

namespace vernier::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr const char* extension = "EXT_lights_image_based";

/// What a viewer inside the cube sees of each face, in the file's order: ahead, to the right and upward.
struct View {
  Vec3f ahead, right, up;
};
const View views[] = {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                      {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}}, {{0, -1, 0}, {-1, 0, 0}, {0, 0, 1}},
                      {{0, 0, 1}, {-1, 0, 0}, {0, 1, 0}},  {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}}};
/// Red, green and blue of the faces: full or none, which no transfer function changes.
constexpr int colors[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
constexpr uint32_t face_size = 16;

/// A face of one colour whose upper left quarter is white.
PngSource face(const int (&color)[3]) {
  PngSource png{.width = face_size, .height = face_size};
  for (uint32_t y = 0; y < face_size; ++y)
    for (uint32_t x = 0; x < face_size; ++x) {
      const bool is_white = 2 * x < face_size && 2 * y < face_size;
      for (const int c : color) png.samples.push_back(is_white || c ? 255 : 0);
    }
  return png;
}

/// A triangle lit by six images.
GltfFile lit_by(const std::vector<PngSource>& faces, json light = json::object()) {
  GltfFile file;
  file.add_triangle();
  json images = json::array();
  for (const PngSource& png : faces) {
    const int view = file.add_view(png_bytes(png));
    images.push_back(file.add("images", {{"bufferView", view}, {"mimeType", "image/png"}}));
  }
  light["specularImages"] = {images};
  light["specularImageSize"] = faces.front().width;
  light["irradianceCoefficients"] = json::array();
  file.json["extensionsUsed"] = {extension};
  file.json["extensions"][extension]["lights"] = {light};
  file.json["scenes"][0]["extensions"][extension]["light"] = 0;
  return file;
}

GltfFile lit_by_colors(const json& light = json::object()) {
  std::vector<PngSource> faces;
  for (const auto& color : colors) faces.push_back(face(color));
  return lit_by(faces, light);
}

/// Six faces of one texel.
std::vector<PngSource> texels(int colour_type, const std::vector<uint8_t>& samples) {
  return std::vector<PngSource>(6, {.colour_type = colour_type, .samples = samples});
}

void expect_radiance(const EnvironmentLight& light, const Vec3f& toward, const Rgb& expected) {
  const Rgb found = light.radiance(normalize(toward));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-3) << toward << " channel " << c;
}

TEST(ImportImageLight, FacesAreSeenUprightFromInside) {
  const SceneDescription scene = lit_by_colors().import();
  ASSERT_TRUE(scene.environment);
  const EnvironmentLight light(scene.environment);
  for (size_t i = 0; i < 6; ++i) {
    const View& view = views[i];
    const Rgb color{float(colors[i][0]), float(colors[i][1]), float(colors[i][2])};
    expect_radiance(light, view.ahead - view.right * 0.5f + view.up * 0.5f, {1, 1, 1});
    expect_radiance(light, view.ahead + view.right * 0.5f + view.up * 0.5f, color);
    expect_radiance(light, view.ahead - view.right * 0.5f - view.up * 0.5f, color);
    expect_radiance(light, view.ahead + view.right * 0.5f - view.up * 0.5f, color);
  }
}

// The environment turns as a node with that rotation would.
TEST(ImportImageLight, RotationAndIntensity) {
  const float half = std::numbers::sqrt2_v<float> / 2;
  // A quarter turn about x takes +y to +z and +z to -y.
  const SceneDescription about_x =
      lit_by_colors({{"rotation", {half, 0, 0, half}}, {"intensity", 2.5}}).import();
  const EnvironmentLight light(about_x.environment);
  expect_radiance(light, {-0.4f, 0.4f, 1}, {0, 0, 2.5f});  // upper right of the face +y
  expect_radiance(light, {0.4f, 0.4f, 1}, {2.5f, 2.5f, 2.5f});
  expect_radiance(light, {0.4f, -1, -0.4f}, {0, 2.5f, 2.5f});  // lower left of the face +z
  expect_radiance(light, {0.4f, -1, 0.4f}, {2.5f, 2.5f, 2.5f});
  // A third of a turn about the diagonal takes x to y, y to z and z to x; not of unit length, which is said.
  const SceneDescription diagonal = lit_by_colors({{"rotation", {1, 1, 1, 1}}}).import();
  EXPECT_TRUE(has_notice(diagonal, "the rotation was not of unit length"));
  // Whatever its length.
  for (const double length : {1e-300, 1e-30, 1e30, 1e300}) {
    const SceneDescription same = lit_by_colors({{"rotation", {length, length, length, length}}}).import();
    EXPECT_EQ(same.environment->picture->values, diagonal.environment->picture->values) << length;
  }
  const EnvironmentLight turned(diagonal.environment);
  const auto after = [](const Vec3f& v) { return Vec3f(v.z, v.x, v.y); };
  for (size_t i = 0; i < 6; ++i) {
    const Vec3f lower_right = views[i].ahead + views[i].right * 0.5f - views[i].up * 0.5f;
    expect_radiance(turned, after(lower_right),
                    {float(colors[i][0]), float(colors[i][1]), float(colors[i][2])});
  }
}

TEST(ImportImageLight, AlphaDividesDecodedColor) {
  const float grey = srgb_to_linear(128 / 255.f);
  const SceneDescription bright = lit_by(texels(6, {255, 128, 0, 51})).import();
  expect_radiance(EnvironmentLight(bright.environment), {0.3f, -0.5f, 0.7f}, {5, grey * 5, 0});
  EXPECT_FALSE(has_notice(bright, "without alpha"));
  const SceneDescription black = lit_by(texels(6, {255, 128, 0, 0})).import();
  expect_radiance(EnvironmentLight(black.environment), {0.3f, -0.5f, 0.7f}, {0, 0, 0});
  const SceneDescription bounded = lit_by(texels(2, {255, 128, 0})).import();
  expect_radiance(EnvironmentLight(bounded.environment), {0.3f, -0.5f, 0.7f}, {1, grey, 0});
  EXPECT_TRUE(has_notice(bounded, "without alpha"));
}

TEST(ImportImageLight, ResamplingKeepsTheEnergy) {
  const SceneDescription scene = lit_by_colors().import();
  const Image& picture = *scene.environment->picture;
  EXPECT_EQ(picture.width, int(4 * face_size));
  EXPECT_EQ(picture.height, int(2 * face_size));
  double sum[3] = {}, total = 0;
  for (int y = 0; y < picture.height; ++y) {
    const double weight = std::sin(std::numbers::pi * (y + 0.5) / picture.height);
    for (int x = 0; x < picture.width; ++x) {
      total += weight;
      for (int c = 0; c < 3; ++c) sum[c] += weight * picture.pixel(x, y)[c];
    }
  }
  // Each colour is in three faces, and a quarter of the others is white; the interpolation between the two is
  // even.
  for (const double s : sum) EXPECT_NEAR(s / total, 3 / 6. + 3 / 6. / 4, 2e-3);
}

TEST(ImportImageLight, SceneWithoutTheExtensionHasNone) {
  GltfFile file = lit_by_colors();
  file.json["scenes"][0].erase("extensions");
  EXPECT_FALSE(file.import().environment);
}

TEST(ImportImageLight, IsReportedAsApproximated) {
  const SceneDescription scene = lit_by_colors().import();
  ASSERT_EQ(scene.features.size(), 1u);
  EXPECT_EQ(scene.features[0].status, FeatureUse::Status::approximated);
  EXPECT_THAT(scene.features[0].note, HasSubstr("Prefiltered Specular Radiance Cubemaps"));
}

TEST(ImportImageLight, RefusesWhatIsMalformed) {
  const std::string light = std::string("/extensions/") + extension + "/lights/0";
  const auto error_after = [](const auto& change) {
    GltfFile file = lit_by_colors();
    change(file.json["extensions"][extension]["lights"][0], file);
    return import_error(file);
  };
  EXPECT_THAT(error_after([](json& l, GltfFile&) { l["specularImages"][0].erase(5); }),
              HasSubstr(light + "/specularImages/0: expected 6 items, found an array of 5"));
  EXPECT_THAT(error_after([](json& l, GltfFile&) { l["specularImages"][0][3] = 6; }),
              HasSubstr(light + "/specularImages/0/3: expected an integer from 0 to 5"));
  EXPECT_THAT(error_after([](json& l, GltfFile&) { l.erase("specularImages"); }),
              HasSubstr(light + ": 'specularImages' is missing"));
  EXPECT_THAT(error_after([](json& l, GltfFile&) { l["specularImageSize"] = 32; }),
              HasSubstr("/images/0: 32 x 32 pixels expected"));
  EXPECT_THAT(error_after([](json& l, GltfFile&) { l["intensity"] = "much"; }),
              HasSubstr(light + "/intensity: "));
  EXPECT_THAT(error_after([](json& l, GltfFile&) {
                l["rotation"] = {0, 0, 0, 0};
              }),
              HasSubstr(light + "/rotation: a rotation must not be zero"));
  EXPECT_THAT(error_after([](json&, GltfFile& file) {
                file.json["scenes"][0]["extensions"][extension]["light"] = 1;
              }),
              HasSubstr(std::string("/scenes/0/extensions/") + extension + "/light: "));
  EXPECT_THAT(error_after([](json&, GltfFile& file) {
                const int view = file.add_view(std::vector<uint8_t>{1, 2, 3, 4});
                file.json["images"][2]["bufferView"] = view;
              }),
              HasSubstr("/images/2: the light's image cannot be read: "));
}

TEST(ImportImageLight, IsAnimatedByPointer) {
  GltfFile file = lit_by_colors();
  const auto animate = [&](const char* property, const std::vector<float>& value, const std::string& type) {
    const json target = {
        {"path", "pointer"},
        {"extensions",
         {{"KHR_animation_pointer",
           {{"pointer", std::string("/extensions/EXT_lights_image_based/lights/0/") + property}}}}}};
    const int input = file.add_accessor(std::vector<float>{0}, "SCALAR");
    const int output = file.add_accessor(value, type);
    file.add("animations", {{"channels", {{{"sampler", 0}, {"target", target}}}},
                            {"samplers", {{{"input", input}, {"output", output}}}}});
  };
  animate("intensity", {5}, "SCALAR");
  animate("rotation", {0, 1, 0, 0}, "VEC4");
  ImportOptions options;
  options.time = 0;
  const SceneDescription scene = file.import(options);
  EXPECT_EQ(scene.environment->scale, 5.f);
  const EnvironmentLight turned(scene.environment);
  expect_radiance(turned, {1, -0.5f, 0.5f}, Rgb(0, 5, 0));
}

}  // namespace
}  // namespace vernier::test
