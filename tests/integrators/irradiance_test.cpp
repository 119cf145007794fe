// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

// Light of every kind on a diffuse floor, against its closed form. The floor at the origin is white: seen
// from above it shows E / pi.

namespace vernier::test {
namespace {

constexpr double pi_d = std::numbers::pi;

SceneBuilder floor_scene() {
  return SceneBuilder().add(parallelogram({-50, 0, -50}, {0, 0, 100}, {100, 0, 0}), diffuse(1));
}

/// Sight of the floor at x on the x axis, from aside so that lights do not stand in the way.
Ray sight(float x) { return ray_through({x, 0.3f, 8}, {x, 0, 0}); }

/// Irradiance at the origin, normal +y, from a polygon of unit radiance wholly above the floor whose corners
/// run clockwise seen from the origin (Lambert 1760): half the sum of edge angle times cosine of the edge's
/// plane.
double polygon_irradiance(const std::vector<Vec3d>& corners) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = normalize(corners[i]), b = normalize(corners[(i + 1) % corners.size()]);
    const Vec3d across = cross(a, b);
    if (length(across) > 0) sum += std::atan2(length(across), dot(a, b)) * normalize(across).y;
  }
  return std::abs(sum) / 2;
}

/// All three techniques see direct light of `irradiance` at x.
void expect_irradiance(const Scene& scene, float x, double irradiance) {
  for (const LightSampling technique : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
    IntegratorOptions options;
    options.max_depth = 2;
    options.light_sampling = technique;
    EXPECT_TRUE(sees(scene, *path(options), sight(x), irradiance / pi_d, 1e-3))
        << "technique " << int(technique) << " at " << x;
  }
}

/// Delta lights are found by light sampling only, and without noise.
void expect_delta_irradiance(const Scene& scene, float x, double irradiance) {
  IntegratorOptions options;
  options.max_depth = 2;
  EXPECT_NEAR(measure(scene, *path(options), sight(x), 4).mean(), irradiance / pi_d, 1e-5 * irradiance);
}

// Over the corner of a rectangle a x b at height c: 1/2 [A atan(b / sqrt(a^2 + c^2)) + B atan(a / sqrt(b^2 +
// c^2))].
TEST(Irradiance, Rectangle) {
  const Scene scene = floor_scene().add(parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), emitter(1)).build();
  const double r = std::sqrt(2.), closed = 0.5 * 2 * (1 / r) * std::atan(1 / r);
  ASSERT_NEAR(closed / pi_d, 0.138532, 1e-6);
  ASSERT_NEAR(polygon_irradiance({{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}), closed, 1e-12);
  expect_irradiance(scene, 0, closed);
  const double aside = polygon_irradiance({{-0.7, 1, 0}, {0.3, 1, 0}, {0.3, 1, 1}, {-0.7, 1, 1}});
  expect_irradiance(scene, 0.7f, aside);
}

// It lights as ever; the camera sees what is behind it, which is nothing.
TEST(Irradiance, OfALampThatIsHiddenFromTheCamera) {
  const auto with_lamp = [](bool hidden) {
    MaterialDescription lamp = emitter(1);
    lamp.hidden_from_camera = hidden;
    return floor_scene().add(parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), lamp).build();
  };
  const Ray up = ray_through({0.5f, 0.5f, 0.5f}, {0.5f, 1, 0.5f});
  EXPECT_EQ(measure(with_lamp(false), *path({}), up, 4).mean(), 1);
  EXPECT_EQ(measure(with_lamp(true), *path({}), up, 4).mean(), 0);
  expect_irradiance(with_lamp(true), 0, 0.138532 * pi_d);
}

// Close to a panel that stands on the floor, and at its foot.
TEST(Irradiance, NearRectangle) {
  const Scene scene =
      floor_scene().add(parallelogram({-1, 0, -0.5f}, {2, 0, 0}, {0, 1.5f, 0}), emitter(1)).build();
  for (const double z : {0.3, 0.02}) {
    const double closed = polygon_irradiance({{-1, 0, -z}, {1, 0, -z}, {1, 1.5, -z}, {-1, 1.5, -z}});
    IntegratorOptions options;
    options.max_depth = 2;
    for (const LightSampling technique : {LightSampling::mis, LightSampling::light, LightSampling::bsdf}) {
      options.light_sampling = technique;
      EXPECT_TRUE(
          sees(scene, *path(options), ray_through({0, 1, 3}, {0, 0, float(z) - 0.5f}), closed / pi_d, 1e-3))
          << "technique " << int(technique) << " at " << z;
    }
  }
}

// A panel whose texture lights two of its sixteen squares.
TEST(Irradiance, TexturedRectangle) {
  MaterialDescription material = emitter(3);
  material.emissive_texture.texture = 0;
  std::vector<uint8_t> texels(16, 0);
  texels[1] = texels[14] = 255;
  const Scene scene = floor_scene()
                          .texture(4, 4, texels)
                          .add(parallelogram({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}), material)
                          .build();
  // Texel 1 is the second along the first edge, in the first row of the second; texel 14 the third in the
  // last.
  const double closed = 3 * (polygon_irradiance({{-0.5, 1, -1}, {0, 1, -1}, {0, 1, -0.5}, {-0.5, 1, -0.5}}) +
                             polygon_irradiance({{0, 1, 0.5}, {0.5, 1, 0.5}, {0.5, 1, 1}, {0, 1, 1}}));
  expect_irradiance(scene, 0, closed);
}

// On and off the axis of a disk of radius R at height h.
TEST(Irradiance, Disk) {
  const double radius = 0.8, h = 1.5;
  const Scene scene = floor_scene().add(disk_facing_down(float(h), float(radius), 256), emitter(2)).build();
  for (const double d : {0., 1.}) {
    const double r2 = radius * radius, s = h * h + d * d + r2;
    const double closed = 2 * (pi_d / 2) * (1 - (h * h + d * d - r2) / std::sqrt(s * s - 4 * r2 * d * d));
    if (d == 0) {
      ASSERT_NEAR(closed, 2 * pi_d * r2 / (r2 + h * h), 1e-12);
    }
    expect_irradiance(scene, float(d), closed * std::sin(2 * pi_d / 256) / (2 * pi_d / 256));
  }
}

// A sphere in full view: pi L (R / d)^2 cos.
TEST(Irradiance, Sphere) {
  const Scene scene = floor_scene().add(sphere({0, 2, 0}, 0.5f, 48, 96), emitter(3)).build();
  for (const float x : {0.f, 1.5f}) {
    const double d2 = 4 + double(x) * x;
    expect_irradiance(scene, x, 3 * pi_d * 0.25 / d2 * 2 / std::sqrt(d2) * 0.9986);
  }
}

TEST(Irradiance, PunctualLights) {
  PunctualLightDescription light;
  light.intensity = 7;
  light.to_world.origin = {0, 2, 0};
  // Local -z down.
  light.to_world.x = {1, 0, 0};
  light.to_world.z = {0, 1, 0};
  light.to_world.y = {0, 0, -1};
  const auto lit = [&] { return floor_scene().add(light).build(); };
  const double x = 1.2, d2 = 4 + x * x, cosine = 2 / std::sqrt(d2);

  light.kind = PunctualLightDescription::Kind::point;
  expect_delta_irradiance(lit(), float(x), 7 * cosine / d2);
  light.range = 3;
  expect_delta_irradiance(lit(), float(x), 7 * cosine / d2 * (1 - std::pow(d2 / 9, 2)));
  light.range = std::numeric_limits<float>::infinity();

  light.kind = PunctualLightDescription::Kind::spot;
  light.inner_cone = 0.2f;
  light.outer_cone = 0.9f;
  const double inner = std::cos(0.2), outer = std::cos(0.9);
  expect_delta_irradiance(lit(), 0, 7 / 4.);
  expect_delta_irradiance(lit(), float(x), 7 * cosine / d2 * std::pow((cosine - outer) / (inner - outer), 2));
  expect_delta_irradiance(lit(), 3, 0);

  light.kind = PunctualLightDescription::Kind::directional;
  light.to_world.z = normalize(Vec3f(1, 2, 0));
  light.to_world.y = normalize(Vec3f(-2, 1, 0));
  light.to_world.x = {0, 0, 1};
  expect_delta_irradiance(lit(), float(x), 7 * 2 / std::sqrt(5.));
}

// Of several punctual lights the path integrator samples one at a time; Whitted's sums them.
TEST(Irradiance, SeveralPunctualLights) {
  SceneBuilder builder = floor_scene();
  double expected = 0;
  for (const auto& [x, intensity] : {std::pair(-1.f, 2.f), std::pair(0.5f, 7.f), std::pair(2.f, 4.f)}) {
    PunctualLightDescription light;
    light.intensity = intensity;
    light.to_world.origin = {x, 2, 0};
    builder.add(light);
    expected += intensity * 2 / std::pow(4 + double(x) * x, 1.5);
  }
  const Scene scene = builder.build();
  IntegratorOptions options;
  options.max_depth = 2;
  options.ambient = 0;
  EXPECT_TRUE(sees(scene, *path(options), sight(0), expected / pi_d, 1e-3));
  EXPECT_NEAR(measure(scene, *make_integrator("whitted", options), sight(0), 1, 1).mean(), expected / pi_d,
              1e-5);
}

/// A floor that wide under a sun at the sun's own scale, and a lid that shades the middle: the sun's power on
/// it is up to 10^10 times a lamp's.
SceneBuilder sun_and_lid(float floor) {
  PunctualLightDescription sun;
  sun.kind = PunctualLightDescription::Kind::directional;
  sun.intensity = 1e5f;
  sun.to_world = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}};
  return SceneBuilder()
      .add(parallelogram({-floor / 2, 0, -floor / 2}, {0, 0, floor}, {floor, 0, 0}), diffuse(1))
      .add(parallelogram({-4, 3, -4}, {8, 0, 0}, {0, 0, 8}), diffuse(0))
      .add(sun);
}

// Lamps have their light beside a sun, where that does not reach and where it does.
TEST(Irradiance, LampsBesideTheSun) {
  for (const float floor : {40.f, 400.f, 4000.f}) {
    SceneBuilder builder = sun_and_lid(floor);
    double in_shade = 0;
    for (const float x : {-1.f, 2.f}) {
      PunctualLightDescription lamp;
      lamp.intensity = 10;
      lamp.to_world.origin = {x, 2, 0};
      builder.add(lamp);
      in_shade += 10 * 2 / std::pow(4 + double(x) * x, 1.5);
    }
    const Scene scene = builder.build();
    IntegratorOptions options;
    options.max_depth = 2;
    const auto sees_at = [&](float x, double irradiance) {
      return sees(scene, *path(options), ray_through({x, 0.3f, 3}, {x, 0, 0}), irradiance / pi_d, 3e-3);
    };
    EXPECT_TRUE(sees_at(0, in_shade)) << floor;
    EXPECT_TRUE(sees_at(9, 1e5)) << floor;
  }
}

// Lamps that shine up and down, back to back: a group of opposite cones has the whole sphere.
TEST(Irradiance, OppositeSpots) {
  for (const int pairs : {4, 12, 40}) {
    SceneBuilder builder;
    builder.add(parallelogram({-20, 0, -20}, {0, 0, 40}, {200, 0, 0}), diffuse(1));
    PunctualLightDescription spot;
    spot.kind = PunctualLightDescription::Kind::spot;
    spot.intensity = 10;
    spot.inner_cone = 0.6f;
    const double inner = std::cos(0.6), outer = std::cos(double(spot.outer_cone)), x = 4.2;
    double expected = 0;
    for (int i = 0; i < pairs; ++i) {
      for (const float side : {-1.f, 1.f}) {
        spot.to_world = {{1, 0, 0}, {0, 0, -side}, {0, side, 0}, {3.f * float(i), 3, 0}};
        builder.add(spot);
      }
      const double d2 = 9 + std::pow(3. * i - x, 2), cosine = 3 / std::sqrt(d2);
      expected += 10 * cosine / d2 * std::pow(std::clamp((cosine - outer) / (inner - outer), 0., 1.), 2);
    }
    IntegratorOptions options;
    options.max_depth = 2;
    EXPECT_TRUE(sees(builder.build(), *path(options), sight(float(x)), expected / pi_d, 3e-3)) << pairs;
  }
}

// Sky a + b cos: E = pi a + 2 pi b / 3.
TEST(Irradiance, Environment) {
  const Scene scene =
      floor_scene()
          .environment([](const Vec3f& w) { return w.y > -0.2f ? 0.5f + 2 * w.y : 0.1f; }, 128)
          .build();
  expect_irradiance(scene, 0, pi_d * 0.5 + 4 * pi_d / 3);
}

// A sun of a few texels: only light sampling finds it well.
TEST(Irradiance, SunInTheEnvironment) {
  const int height = 256;
  const Vec3f sun = normalize(Vec3f(0.3f, 1, -0.2f));
  const auto radiance = [&](const Vec3f& w) { return dot(w, sun) > std::cos(0.02f) ? 1e4f : 0.f; };
  const Scene scene = floor_scene().environment(radiance, height).build();
  // The picture is interpolated, so the sum over texels of radiance times solid angle holds.
  double expected = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const double theta = pi_d * (y + 0.5) / height, phi = pi_d * ((x + 0.5) / height - 1);
      const Vec3f w(float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                    float(std::sin(theta) * std::sin(phi)));
      expected += radiance(w) * std::cos(theta) * std::sin(theta) * (pi_d / height) * (pi_d / height);
    }
  for (const LightSampling technique : {LightSampling::mis, LightSampling::light}) {
    IntegratorOptions options;
    options.max_depth = 2;
    options.light_sampling = technique;
    EXPECT_TRUE(sees(scene, *path(options), sight(0), expected / pi_d, 3e-3));
  }
}

// Whitted's direct light is the same: all punctual lights, and one sample of the others.
TEST(Irradiance, Whitted) {
  PunctualLightDescription light;
  light.intensity = 7;
  light.to_world.origin = {0, 2, 0};
  const Scene scene =
      floor_scene().add(parallelogram({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), emitter(1)).add(light).build();
  IntegratorOptions options;
  options.ambient = 0;
  const double area = polygon_irradiance({{0.7, 1, 0}, {1.7, 1, 0}, {1.7, 1, 1}, {0.7, 1, 1}});
  const double point = 7 * 2 / std::pow(4 + 0.49, 1.5);
  EXPECT_TRUE(sees(scene, *make_integrator("whitted", options), sight(-0.7f), (area + point) / pi_d, 2e-3));
}

}  // namespace
}  // namespace vernier::test
