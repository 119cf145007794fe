// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/environment.h"

#include "core/base/parallel.h"
#include "scene/lights/infinite_disk.h"

namespace vernier {
namespace {

/// Of the angle to the vertical; w is a unit vector.
float sine(const Vec3f& w) { return std::sqrt(w.x * w.x + w.z * w.z); }

}  // namespace

EnvironmentLight::EnvironmentLight(std::shared_ptr<const EnvironmentDescription> description)
    : description_(std::move(description)),
      cos_rotation_(std::cos(description_->rotation)),
      sin_rotation_(std::sin(description_->rotation)) {
  const Image& picture = *description_->picture;
  const int w = picture.width, h = picture.height;
  for (const float v : picture.values) bad_texels_ += !(std::isfinite(v) && v >= 0);
  // The density of a cell is the mean over it of the interpolated picture (weights 1 6 1 over 8 in each
  // axis), so that it is positive wherever interpolation makes light, however small the lit texel.
  std::vector<float> luminances(size_t(w) * h), weights(size_t(w) * h);
  parallel_for(size_t(h), [&](size_t y) {
    for (int x = 0; x < w; ++x) luminances[y * w + x] = luminance(texel(x, int(y)));
  });
  parallel_for(size_t(h), [&](size_t row) {
    const int y = int(row);
    const float* rows[3] = {&luminances[size_t(std::max(y - 1, 0)) * w], &luminances[size_t(y) * w],
                            &luminances[size_t(std::min(y + 1, h - 1)) * w]};
    const float solid_angle = std::sin(pi * (float(y) + 0.5f) / float(h));
    for (int x = 0; x < w; ++x) {
      const int left = (x + w - 1) % w, right = (x + 1) % w;
      const auto across = [&](const float* r) { return (r[left] + 6 * r[x] + r[right]) / 8; };
      weights[row * w + x] = (across(rows[0]) + 6 * across(rows[1]) + across(rows[2])) / 8 * solid_angle;
    }
  });
  distribution_ = Distribution2D(weights, w, h);
}

Rgb EnvironmentLight::texel(int x, int y) const {
  Rgb value = rgb_at(*description_->picture, x, y);
  if (bad_texels_ == 0) return value;
  for (int c = 0; c < 3; ++c)
    if (!(std::isfinite(value[c]) && value[c] >= 0)) value[c] = 0;
  return value;
}

Rgb EnvironmentLight::lookup(const Vec2f& uv) const {
  const int w = description_->picture->width, h = description_->picture->height;
  const float x = uv.x * float(w) - 0.5f, y = uv.y * float(h) - 0.5f;
  const float x_floor = std::floor(x), y_floor = std::floor(y);
  const float fx = x - x_floor, fy = y - y_floor;
  const int x0 = x_floor < 0 ? w - 1 : int(x_floor), x1 = x0 + 1 < w ? x0 + 1 : 0;
  const int y0 = std::clamp(int(y_floor), 0, h - 1), y1 = std::clamp(int(y_floor) + 1, 0, h - 1);
  const Rgb top = texel(x0, y0) * (1 - fx) + texel(x1, y0) * fx;
  const Rgb bottom = texel(x0, y1) * (1 - fx) + texel(x1, y1) * fx;
  return (top * (1 - fy) + bottom * fy) * description_->scale;
}

Vec2f EnvironmentLight::to_uv(const Vec3f& w) const {
  const float x = cos_rotation_ * w.x - sin_rotation_ * w.z;
  const float z = sin_rotation_ * w.x + cos_rotation_ * w.z;
  const float u = std::atan2(z, x) * (inv_pi / 2) + 0.5f;
  const float v = std::acos(std::clamp(w.y, -1.f, 1.f)) * inv_pi;
  // A direction that is none gets a place all the same, since texels are read at it.
  return {u >= 0 ? std::min(u, 0x1.fffffep-1f) : 0, v >= 0 ? v : 0};
}

Vec3f EnvironmentLight::direction(const Vec2f& uv) const {
  const float theta = uv.y * pi, phi = (uv.x - 0.5f) * 2 * pi;
  const float sin_theta = std::sin(theta);
  const float x = sin_theta * std::cos(phi), z = sin_theta * std::sin(phi);
  return {cos_rotation_ * x + sin_rotation_ * z, std::cos(theta), -sin_rotation_ * x + cos_rotation_ * z};
}

Rgb EnvironmentLight::radiance(const Vec3f& w) const { return lookup(to_uv(w)); }

std::optional<LightSample> EnvironmentLight::sample(const SurfacePoint& from, const Vec2d& u) const {
  if (distribution_.empty()) return std::nullopt;
  float pdf;
  const Vec2f uv = distribution_.sample(u, pdf);
  const Vec3f wi = direction(uv);
  const float sin_theta = sine(wi);
  if (!(pdf > 0) || !(sin_theta > 0)) return std::nullopt;
  return LightSample{wi, lookup(uv), pdf / (2 * pi * pi * sin_theta), false, from.spawn(wi), {}};
}

std::optional<LightRay> EnvironmentLight::emit(const Bounds& scene, const Vec2d& place,
                                               const Vec2f& direction, float time) const {
  if (distribution_.empty()) return std::nullopt;
  float pdf;
  const Vec2f uv = distribution_.sample(place, pdf);
  const Vec3f wi = this->direction(uv);
  const float sin_theta = sine(wi);
  if (!(pdf > 0) || !(sin_theta > 0)) return std::nullopt;
  return emit_from_infinity(scene, -wi, lookup(uv) * (2 * pi * pi * sin_theta / pdf), direction, time);
}

LightEval EnvironmentLight::eval(const SurfacePoint& /*from*/, const Vec3f& wi,
                                 const SurfacePoint* /*on*/) const {
  const Vec2f uv = to_uv(wi);
  const float sin_theta = sine(wi);
  const float pdf =
      distribution_.empty() || !(sin_theta > 0) ? 0 : distribution_.pdf(uv) / (2 * pi * pi * sin_theta);
  return {lookup(uv), pdf};
}

float EnvironmentLight::power(const Bounds& scene) const {
  // integral() is the mean of luminance times sin(theta) over the picture; 2 pi^2 of that is the integral
  // over directions, and the scene's disk receives it.
  const float radius = scene.empty() ? 1 : scene.radius();
  return float(2 * pi * pi * distribution_.integral()) * description_->scale * pi * square(radius);
}

}  // namespace vernier
