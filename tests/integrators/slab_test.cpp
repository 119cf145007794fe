// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_scenes.h"

// A plane-parallel slab of absorbing glass, seen against a bright half of the sky.

namespace vernier::test {
namespace {

constexpr float thickness = 0.1f, index = 1.5f;

Scene slab(float absorption, float above, float below) {
  MaterialDescription material = glass(0);
  material.attenuation_distance = 1;
  material.attenuation_color = Rgb(std::exp(-absorption));
  return SceneBuilder()
      .add(box({-5, 0, -5}, {5, thickness, 5}), material)
      .environment([=](const Vec3f& w) { return w.y > 0 ? above : below; }, 2)
      .build();
}

double fresnel(double cos_i, double& cos_t) {
  cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (index * index));
  const double p = (index * cos_i - cos_t) / (index * cos_i + cos_t),
               s = (cos_i - index * cos_t) / (cos_i + index * cos_t);
  return (p * p + s * s) / 2;
}

struct Closed {
  double transmitted, reflected;
};

/// All orders: T = (1 - F)^2 tau / (1 - F^2 tau^2), R = F + F tau T; tau = exp(-sigma d / cos_t).
Closed closed_form(double cos_i, double absorption) {
  double cos_t;
  const double f = fresnel(cos_i, cos_t), tau = std::exp(-absorption * thickness / cos_t);
  const double t = (1 - f) * (1 - f) * tau / (1 - f * f * tau * tau);
  return {t, f + f * tau * t};
}

// Two rows of sky are interpolated between 45 degrees up and down, so sight lines are steeper than that.
Ray sight(float cosine) {
  const float sine = safe_sqrt(1 - cosine * cosine);
  return ray_through({sine, thickness + cosine, 0}, {0, thickness, 0});
}

TEST(Slab, TransmitsAndReflectsInClosedForm) {
  ASSERT_NEAR(closed_form(1, 0).transmitted, 2 * index / (index * index + 1), 1e-6);
  for (const float absorption : {0.f, 8.f})
    for (const float cosine : {1.f, 0.8f}) {
      const Closed closed = closed_form(cosine, absorption);
      IntegratorOptions options;
      options.max_depth = 200;
      options.cutoff = 1e-7f;
      options.ambient = 0;
      const Scene through = slab(absorption, 0, 1), off = slab(absorption, 1, 0);
      const Ray ray = sight(cosine);
      EXPECT_TRUE(sees(through, *path(options), ray, closed.transmitted, 2e-3));
      EXPECT_TRUE(sees(off, *path(options), ray, closed.reflected, 1e-2));
      options.max_depth = 20;
      const auto whitted = make_integrator("whitted", options);
      EXPECT_NEAR(measure(through, *whitted, ray, 1, 1).mean(), closed.transmitted, 2e-5);
      EXPECT_NEAR(measure(off, *whitted, ray, 1, 1).mean(), closed.reflected, 2e-5);
    }
}

}  // namespace
}  // namespace vernier::test
