// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ImathColor.h>
#include <ImathVec.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vernier {

using Vec2f = Imath::V2f;
using Vec2d = Imath::V2d;
using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
using Vec4f = Imath::V4f;

/// Linear Rec.709 (sRGB primaries, D65) colour: radiance in W m^-2 sr^-1, or a dimensionless reflectance or
/// weight.
using Rgb = Imath::C3f;

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;

template <typename T>
T dot(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
Imath::Vec3<T> cross(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
T length_squared(const Imath::Vec3<T>& v) {
  return dot(v, v);
}

template <typename T>
T length(const Imath::Vec3<T>& v) {
  return std::sqrt(dot(v, v));
}

/// v / |v|. v must not be zero; Imath's own normalize tests for that and for underflow at each call.
template <typename T>
Imath::Vec3<T> normalize(const Imath::Vec3<T>& v) {
  return v * (T(1) / length(v));
}

template <typename T>
Imath::Vec3<T> abs(const Imath::Vec3<T>& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

template <typename T>
Imath::Vec3<T> min(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}

template <typename T>
Imath::Vec3<T> max(const Imath::Vec3<T>& a, const Imath::Vec3<T>& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

inline bool is_finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline float max_component(const Vec3f& v) { return std::max(v.x, std::max(v.y, v.z)); }

inline bool is_black(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }

/// Relative luminance of linear Rec.709 (ITU-R BT.709-6, 3.2).
inline float luminance(const Rgb& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

inline float lerp(float t, float a, float b) { return (1 - t) * a + t * b; }
template <typename T>
constexpr T square(T x) {
  return x * x;
}
/// sqrt(max(0, x)): for 1 - x^2 that rounding may push below zero.
inline float safe_sqrt(float x) { return std::sqrt(std::max(0.f, x)); }

}  // namespace vernier
