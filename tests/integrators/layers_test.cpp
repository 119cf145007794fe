// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/layers.h"

#include <cmath>

#include "core/base/parallel.h"
#include "scene/camera.h"
#include "tests/support/test_scenes.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

constexpr int size = 16;

// The camera looks along -z at a wall two metres away that fills the left half of the picture and the first
// quarter of the pixels right of the middle; before its lower part, one metre away, is another.
Scene two_walls() {
  const float pixel = 2 * 2 * std::tan(0.5f) / size;  // at the far wall
  return SceneBuilder()
      .add(parallelogram({-5, -5, -2}, {5 + pixel / 4, 0, 0}, {0, 10, 0}), diffuse(0.5f))
      .add(parallelogram({-5, -5, -1}, {5, 0, 0}, {0, 5, 0}), diffuse(0.25f))
      .environment([](const Vec3f&) { return 1.f; })
      .build();
}

class Layers : public testing::Test {
 protected:
  Layers() {
    options_.width = options_.height = size;
    options_.limits.spp = 16;
    options_.adaptive = false;
  }

  LayeredImage picture(const std::string& list) {
    const Camera camera(view_, options_.width, options_.height);
    const std::atomic<bool> stop = false;
    const auto integrator = path({});
    options_.light_split.ways = light_ways_of(find_layers(list));
    const RenderResult result = render(scene_, camera, *integrator, options_, stop);
    return with_layers(result, find_layers(list), scene_, camera, options_, &moments_);
  }

  const Scene scene_ = two_walls();
  CameraDescription view_ = [] {
    CameraDescription camera;
    camera.yfov = 1;
    return camera;
  }();
  RenderSettings options_;
  /// Everything stands still, unless a test says otherwise.
  Moments moments_{{{std::shared_ptr<const Scene>(), &scene_}, view_},
                   {{std::shared_ptr<const Scene>(), &scene_}, view_}};
};

TEST_F(Layers, FirstHitsAreWhatIsThere) {
  const LayeredImage layered = picture("all");
  const Image albedo = *layered.layer("albedo"), normal = *layered.layer("N"), point = *layered.layer("P");
  const Image depth = *layered.single("Z"), id = *layered.single("id"),
              coverage = *layered.single("coverage");
  const int far_y = 3, near_y = size - 4, wall_x = 4, sky_x = 12;
  for (const auto& [y, distance, reflectance, number] :
       {std::tuple{far_y, 2.f, 0.5f, 1.f}, {near_y, 1.f, 0.25f, 2.f}}) {
    EXPECT_NEAR(rgb_at(albedo, wall_x, y).x, reflectance, 1e-6);
    EXPECT_NEAR(length(rgb_at(normal, wall_x, y) - Vec3f(0, 0, 1)), 0, 1e-6);
    EXPECT_NEAR(*depth.pixel(wall_x, y), distance, 1e-6) << "along the axis, not along the ray";
    const float to_edge = distance * std::tan(0.5f);
    const Vec3f expected(to_edge * (2 * (wall_x + 0.5f) / size - 1),
                         to_edge * (1 - 2 * (float(y) + 0.5f) / size), -distance);
    EXPECT_NEAR(length(rgb_at(point, wall_x, y) - expected), 0, 1e-5);
    EXPECT_EQ(*id.pixel(wall_x, y), number);
    EXPECT_EQ(*coverage.pixel(wall_x, y), 1);
  }
  EXPECT_EQ(rgb_at(albedo, sky_x, far_y), Rgb(0, 0, 0));
  EXPECT_EQ(rgb_at(normal, sky_x, far_y), Vec3f(0, 0, 0));
  EXPECT_EQ(rgb_at(point, sky_x, far_y), Vec3f(0, 0, 0));
  EXPECT_TRUE(std::isinf(*depth.pixel(sky_x, far_y)));
  EXPECT_EQ(*id.pixel(sky_x, far_y), 0);
  EXPECT_EQ(*coverage.pixel(sky_x, far_y), 0);
  // Sixteen stratified samples see a quarter to within one of each half.
  EXPECT_NEAR(*coverage.pixel(size / 2, far_y), 0.25, 2.0 / 16);
  EXPECT_NEAR(rgb_at(albedo, size / 2, far_y).x, 0.5 * *coverage.pixel(size / 2, far_y), 1e-6);
}

TEST_F(Layers, WhatThePixelsCentreShowsIsSharpBehindALens) {
  const LayeredImage sharp = picture("depth,position,id,coverage");
  view_.lens_radius = 0.3f;
  view_.focus_distance = 0.5f;
  const LayeredImage blurred = picture("depth,position,id,coverage");
  for (const char* channel : {"Z", "P.X", "P.Y", "P.Z", "id"})
    EXPECT_EQ(blurred.single(channel)->values, sharp.single(channel)->values) << channel;
  EXPECT_NE(blurred.single("coverage")->values, sharp.single("coverage")->values);
}

TEST_F(Layers, HalvesAreTwoPicturesWithThatMean) {
  const LayeredImage layered = picture("half,error,samples,variance");
  const Image mean = layered.rgb(), a = *layered.layer("half1"), b = *layered.layer("half2");
  const Image error = *layered.layer("error"), variance = *layered.layer("variance");
  double squared_error = 0, squared_difference = 0, from_variance = 0;
  for (size_t i = 0; i < mean.values.size(); ++i) {
    EXPECT_NEAR(mean.values[i], (a.values[i] + b.values[i]) / 2, 1e-6);
    squared_error += square(error.values[i]);
    squared_difference += square((a.values[i] - b.values[i]) / 2);
    from_variance += variance.values[i] / 16;
  }
  EXPECT_NE(a.values, b.values);
  EXPECT_NEAR(squared_error / squared_difference, 1, 0.3);
  EXPECT_GE(from_variance, squared_error) << "stratified samples do better than independent ones";
  EXPECT_EQ(layered.channel_names[6], "error.unreliable");
  EXPECT_EQ(*layered.single("samples")->pixel(3, 3), 16);
}

TEST_F(Layers, EveryLayerAloneIsThatOfAll) {
  options_.limits.spp = 40;
  options_.adaptive = true;
  const LayeredImage all = picture("all,light,motion");
  EXPECT_EQ(picture("").channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(picture("").image.values, all.rgb().values);
  for (const Layer& layer : layers()) {
    const LayeredImage alone = picture(std::string(layer.name));
    ASSERT_EQ(alone.image.channels, 3 + layer.channel_count()) << layer.name;
    for (int c = 0; c < layer.channel_count(); ++c) {
      const std::string channel(layer.channels[size_t(c)]);
      EXPECT_EQ(alone.single(channel)->values, all.single(channel)->values) << channel;
    }
  }
}

TEST_F(Layers, SameForAnyNumberOfThreadsAndInACrop) {
  const LayeredImage whole = picture("all");
  {
    const ThreadLimit one(1);
    EXPECT_EQ(picture("all").image.values, whole.image.values);
  }
  options_.crop = {6, 5, 7, 4};
  const LayeredImage part = picture("all");
  // `error` is pooled from a pixel's surroundings, of which the crop has fewer.
  for (const std::string& channel : whole.channel_names) {
    if (channel.starts_with("error")) continue;
    const Image expected = *whole.single(channel), got = *part.single(channel);
    for (int y = 0; y < got.height; ++y)
      for (int x = 0; x < got.width; ++x)
        EXPECT_EQ(*got.pixel(x, y), *expected.pixel(x + 6, y + 5)) << channel;
  }
}

TEST(LayerNames, AreInTheTablesOrderAndOnce) {
  const auto found = find_layers("albedo,error,albedo");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].name, "error");
  const size_t unasked = light_way_names().size() + 2;  // with groups of lights, and motion
  EXPECT_EQ(find_layers("all").size(), layers().size() - unasked);
  EXPECT_EQ(find_layers("error,all").size(), layers().size() - unasked);
  EXPECT_EQ(find_layers("all,light,light_groups,motion").size(), layers().size());
  for (const char* bad : {"albdo", "error,", ",", "error,,albedo", " error"})
    EXPECT_THROW(find_layers(bad), Error) << bad;
}

TEST(LayerNames, NoTwoLayersShareAChannel) {
  std::vector<std::string_view> channels{"R", "G", "B", "A"};
  for (const Layer& layer : layers())
    for (int c = 0; c < layer.channel_count(); ++c) {
      const auto channel = layer.channels[size_t(c)];
      EXPECT_EQ(std::count(channels.begin(), channels.end(), channel), 0) << channel;
      channels.push_back(channel);
    }
}

}  // namespace
}  // namespace vernier::test
