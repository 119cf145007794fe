// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/ground_light.h"

#include "core/base/parallel.h"

namespace vernier {

GroundLight::GroundLight(const EnvironmentLight* environment, std::vector<const Light*> lamps)
    : environment_(environment), lamps_(std::move(lamps)) {
  if (!environment) return;
  const int width = environment->description().picture->width;
  const int height = environment->description().picture->height, rows = (height + 1) / 2;
  std::vector<float> weights(size_t(width) * size_t(rows));
  parallel_for(size_t(rows), [&](size_t y) {
    const float theta = pi * (float(y) + 0.5f) / float(height);
    const float cosine_and_angle = std::max(0.f, std::cos(theta)) * std::sin(theta);
    for (int x = 0; x < width; ++x) {
      const Vec2f uv((float(x) + 0.5f) / float(width), (float(y) + 0.5f) / float(height));
      weights[y * size_t(width) + size_t(x)] =
          luminance(environment->radiance(environment->direction(uv))) * cosine_and_angle;
    }
  });
  upper_half_ = Distribution2D(weights, width, rows);
  rows_share_ = float(rows) / float(height);
  environment_irradiance_ = 2 * pi * pi * double(rows_share_) * upper_half_.integral();
}

std::optional<LightSample> GroundLight::sample(const SurfacePoint& from, double u, const Vec2d& v) const {
  const auto lamp_at = [&](const Light* lamp) { return lamp->sample(from, {0.5, 0.5}); };
  const auto irradiance = [](const std::optional<LightSample>& lamp) {
    return lamp ? double(luminance(lamp->radiance) * std::max(0.f, lamp->wi.y)) : 0;
  };
  double sum = environment_irradiance_;
  for (const Light* lamp : lamps_) sum += irradiance(lamp_at(lamp));
  double left = u * sum - environment_irradiance_;
  if (left < 0) {
    float pdf;
    const Vec2f place = upper_half_.sample(v, pdf);
    LightSample sample;
    sample.wi = environment_->direction({place.x, place.y * rows_share_});
    if (!(sample.wi.y > 0)) return std::nullopt;
    sample.shadow = from.spawn(sample.wi);
    return sample;
  }
  for (const Light* lamp : lamps_) {
    auto sample = lamp_at(lamp);
    left -= irradiance(sample);
    if (left < 0) return sample;
  }
  return std::nullopt;
}

}  // namespace vernier
