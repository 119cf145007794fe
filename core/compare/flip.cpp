// SPDX-License-Identifier: Apache-2.0
#include "core/compare/flip.h"

#include <fmt/format.h>

#include <array>
#include <limits>

#include "core/base/parallel.h"
#include "core/denoise/convolve.h"
#include "vernier/error.h"

namespace vernier {
namespace {

// Equation and section numbers are those of the 2020 paper.

constexpr float color_exponent = 0.7f;           // q_c
constexpr float color_knee = 0.4f;               // p_c, as a part of the largest difference
constexpr float color_knee_value = 0.95f;        // p_t
constexpr float feature_width_degrees = 0.082f;  // w
constexpr float feature_exponent = 0.5f;         // q_f

constexpr std::array<float, 3> white{0.950428545f, 1.f, 1.088900371f};  // D65, XYZ

Vec3f rgb_to_xyz(const Vec3f& c) {
  return {0.41238656f * c.x + 0.35759149f * c.y + 0.18045049f * c.z,
          0.21263682f * c.x + 0.71518298f * c.y + 0.07218020f * c.z,
          0.01933062f * c.x + 0.11919716f * c.y + 0.95037259f * c.z};
}

Vec3f xyz_to_rgb(const Vec3f& c) {
  return {3.241003275f * c.x - 1.537398934f * c.y - 0.498615861f * c.z,
          -0.969224334f * c.x + 1.875930071f * c.y + 0.041554224f * c.z,
          0.055639423f * c.x - 0.204011202f * c.y + 1.057148933f * c.z};
}

// The linear opponent space Y Cx Cz (section 4.1.1).
Vec3f rgb_to_opponent(const Vec3f& c) {
  const Vec3f xyz = rgb_to_xyz(c);
  const float x = xyz.x / white[0], y = xyz.y / white[1], z = xyz.z / white[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3f opponent_to_rgb(const Vec3f& c) {
  const float y = (c.x + 16) / 116;
  return xyz_to_rgb({(y + c.y / 500) * white[0], y * white[1], (y - c.z / 200) * white[2]});
}

// CIE L*a*b* whose chroma is scaled by lightness after Hunt (section 4.1.2).
Vec3f rgb_to_hunt_lab(const Vec3f& c) {
  const Vec3f xyz = rgb_to_xyz(c);
  const auto f = [](float t) {
    constexpr float delta = 6.f / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.f / 29;
  };
  const float x = f(xyz.x / white[0]), y = f(xyz.y / white[1]), z = f(xyz.z / white[2]);
  const float lightness = 116 * y - 16;
  return {lightness, 0.01f * lightness * 500 * (x - y), 0.01f * lightness * 200 * (y - z)};
}

// Abasi et al. 2020, a distance for large colour differences.
float hyab(const Vec3f& a, const Vec3f& b) {
  const Vec3f d = a - b;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// Difference in [0, 1] of a colour distance (section 4.1.3).
float redistribute(float distance) {
  static const float largest =
      std::pow(hyab(rgb_to_hunt_lab({0, 1, 0}), rgb_to_hunt_lab({0, 0, 1})), color_exponent);
  const float d = std::pow(distance, color_exponent), knee = color_knee * largest;
  return d < knee ? color_knee_value / knee * d
                  : color_knee_value + (d - knee) / (largest - knee) * (1 - color_knee_value);
}

// exp(-pi^2 x^2 / b), x in degrees, over the pixels of one axis.
std::vector<float> csf_kernel(float b, int radius, float pixels_per_degree) {
  std::vector<float> kernel;
  for (int i = -radius; i <= radius; ++i)
    kernel.push_back(std::exp(-square(pi * float(i) / pixels_per_degree) / b));
  return kernel;
}

void scale_to_sum(std::vector<float>& kernel, float sum) {
  double total = 0;
  for (const float weight : kernel) total += weight;
  for (float& weight : kernel) weight *= float(sum / total);
}

// Contrast sensitivity of one opponent channel: a sum of two Gaussians, or one where a2 is 0 (table 1).
struct Sensitivity {
  float a1, b1, a2, b2;
};
constexpr Sensitivity sensitivities[3] = {
    {1, 0.0047f, 0, 1}, {1, 0.0053f, 0, 1}, {34.1f, 0.04f, 13.5f, 0.025f}};

Image filter_channel(const Image& plane, const Sensitivity& s, float pixels_per_degree) {
  constexpr float widest = 0.04f;  // the largest b of all channels sets the radius of each
  const int radius = int(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
  auto first = csf_kernel(s.b1, radius, pixels_per_degree);
  if (s.a2 == 0) {
    scale_to_sum(first, 1);
    return convolve(plane, first, first);
  }
  auto second = csf_kernel(s.b2, radius, pixels_per_degree);
  // The two-dimensional kernel, not each of its parts, sums to 1.
  const auto weight = [](float a, float b, const std::vector<float>& kernel) {
    double sum = 0;
    for (const float w : kernel) sum += w;
    return a * std::sqrt(double(pi) / b) * sum * sum;
  };
  const double w1 = weight(s.a1, s.b1, first), w2 = weight(s.a2, s.b2, second);
  scale_to_sum(first, float(std::sqrt(w1 / (w1 + w2))));
  scale_to_sum(second, float(std::sqrt(w2 / (w1 + w2))));
  Image sum = convolve(plane, first, first);
  const Image other = convolve(plane, second, second);
  for (size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += other.values[i];
  return sum;
}

using Planes = std::array<Image, 3>;

Planes opponent_planes(const Image& linear) {
  Planes planes;
  for (Image& plane : planes) plane = Image(linear.width, linear.height, 1);
  parallel_for(size_t(linear.height), [&](size_t y) {
    for (int x = 0; x < linear.width; ++x) {
      const Vec3f c = rgb_to_opponent(rgb_at(linear, x, int(y)));
      for (int i = 0; i < 3; ++i) *planes[i].pixel(x, int(y)) = c[i];
    }
  });
  return planes;
}

// What the eye resolves, in the perceptually uniform space of the colour difference.
Image perceived(const Planes& opponent, float pixels_per_degree) {
  Planes filtered;
  for (int i = 0; i < 3; ++i) filtered[i] = filter_channel(opponent[i], sensitivities[i], pixels_per_degree);
  Image result(filtered[0].width, filtered[0].height, 3);
  parallel_for(size_t(result.height), [&](size_t y) {
    for (int x = 0; x < result.width; ++x) {
      Vec3f c;
      for (int i = 0; i < 3; ++i) c[i] = *filtered[i].pixel(x, int(y));
      Vec3f rgb = opponent_to_rgb(c);
      for (int i = 0; i < 3; ++i) rgb[i] = std::clamp(rgb[i], 0.f, 1.f);
      const Vec3f lab = rgb_to_hunt_lab(rgb);
      for (int i = 0; i < 3; ++i) result.pixel(x, int(y))[i] = lab[i];
    }
  });
  return result;
}

// Positive weights sum to 1 and negative ones to -1 (section 4.2.1).
void balance(std::vector<float>& kernel) {
  double positive = 0, negative = 0;
  for (const float weight : kernel) (weight > 0 ? positive : negative) += std::abs(weight);
  for (float& weight : kernel) weight = float(weight / (weight > 0 ? positive : negative));
}

// Strength of edges and of points in the achromatic plane: two channels (section 4.2).
Image features(const Image& achromatic, float pixels_per_degree) {
  const float deviation = 0.5f * feature_width_degrees * pixels_per_degree;
  const int radius = int(std::ceil(3 * deviation));
  std::vector<float> smooth, edge, point;
  for (int i = -radius; i <= radius; ++i) {
    const float x = float(i) / deviation, g = std::exp(-0.5f * x * x);
    smooth.push_back(g);
    edge.push_back(-x * g);
    point.push_back((x * x - 1) * g);
  }
  scale_to_sum(smooth, 1);
  balance(edge);
  balance(point);
  Image normalized = achromatic;
  for (float& y : normalized.values) y = (y + 16) / 116;
  const Image edge_x = convolve(normalized, edge, smooth), edge_y = convolve(normalized, smooth, edge);
  const Image point_x = convolve(normalized, point, smooth), point_y = convolve(normalized, smooth, point);
  Image result(achromatic.width, achromatic.height, 2);
  for (size_t i = 0; i < normalized.values.size(); ++i) {
    result.values[2 * i] = std::hypot(edge_x.values[i], edge_y.values[i]);
    result.values[2 * i + 1] = std::hypot(point_x.values[i], point_y.values[i]);
  }
  return result;
}

// The map for linear values in [0, 1].
Image flip_map(const Image& x, const Image& reference, float pixels_per_degree) {
  const Planes opponent_x = opponent_planes(x), opponent_r = opponent_planes(reference);
  const Image color_x = perceived(opponent_x, pixels_per_degree);
  const Image color_r = perceived(opponent_r, pixels_per_degree);
  const Image feature_x = features(opponent_x[0], pixels_per_degree);
  const Image feature_r = features(opponent_r[0], pixels_per_degree);
  Image map(x.width, x.height, 1);
  parallel_for(size_t(x.height), [&](size_t row) {
    const int y = int(row);
    for (int column = 0; column < x.width; ++column) {
      const float color = redistribute(hyab(rgb_at(color_x, column, y), rgb_at(color_r, column, y)));
      const float* fx = feature_x.pixel(column, y);
      const float* fr = feature_r.pixel(column, y);
      const float feature = std::max(std::abs(fx[0] - fr[0]), std::abs(fx[1] - fr[1]));
      const float exponent = 1 - std::pow(feature / std::numbers::sqrt2_v<float>, feature_exponent);
      *map.pixel(column, y) = std::clamp(std::pow(color, exponent), 0.f, 1.f);
    }
  });
  return map;
}

double mean_of(const Image& map) {
  double sum = 0;
  for (const float value : map.values) sum += value;
  return map.empty() ? 0 : sum / double(map.values.size());
}

void check_sizes(const Image& x, const Image& reference) {
  if (x.width != reference.width || x.height != reference.height || x.channels < 3 || reference.channels < 3)
    throw Error(ErrorKind::usage, fmt::format("pictures of {}x{} and {}x{} pixels cannot be compared",
                                              x.width, x.height, reference.width, reference.height));
}

template <typename Function>
Image map_rgb(const Image& image, const Function& function) {
  Image result(image.width, image.height, 3);
  parallel_for(size_t(image.height), [&](size_t y) {
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) result.pixel(x, int(y))[c] = function(image.pixel(x, int(y))[c]);
  });
  return result;
}

// Narkowicz 2016, "ACES Filmic Tone Mapping Curve", with the 0.6 that cancels its pre-exposure: numerator
// (k0 x + k1) x, denominator (k3 x + k4) x + k5.
constexpr double k0 = 0.6 * 0.6 * 2.51, k1 = 0.6 * 0.03, k3 = 0.6 * 0.6 * 2.43, k4 = 0.6 * 0.59, k5 = 0.14;

float tone_map(float value, float scale) {
  if (!(value > 0)) return 0;
  const double x = std::min(1e9, double(value) * scale);
  return float(std::clamp((k0 * x + k1) * x / ((k3 * x + k4) * x + k5), 0.0, 1.0));
}

// Exposures, in stops, that bring the brightest and the median luminance of the reference to 0.85.
std::array<double, 2> exposure_range(const Image& reference) {
  constexpr double t = 0.85;
  constexpr double b = (k1 - k4 * t) / (k0 - k3 * t), c = -k5 * t / (k0 - k3 * t);
  const double mapped_to_t = -0.5 * b + std::sqrt(0.25 * b * b - c);
  std::vector<float> luminances;
  for (int y = 0; y < reference.height; ++y)
    for (int x = 0; x < reference.width; ++x) {
      const float value = luminance(rgb_at(reference, x, y));
      if (std::isfinite(value)) luminances.push_back(std::max(0.f, value));
    }
  if (luminances.empty()) return {0, 0};
  std::sort(luminances.begin(), luminances.end());
  if (luminances.back() == 0) return {0, 0};
  const size_t n = luminances.size();
  const double median = 0.5 * (double(luminances[(n - 1) / 2]) + luminances[n / 2]);
  constexpr double smallest = std::numeric_limits<float>::epsilon();
  return {std::log2(mapped_to_t / luminances.back()), std::log2(mapped_to_t / std::max(smallest, median))};
}

}  // namespace

FlipResult flip(const Image& x, const Image& reference, float pixels_per_degree) {
  check_sizes(x, reference);
  const auto decode = [](float value) { return value > 0 ? srgb_to_linear(std::min(1.f, value)) : 0.f; };
  FlipResult result;
  result.map = flip_map(map_rgb(x, decode), map_rgb(reference, decode), pixels_per_degree);
  result.mean = mean_of(result.map);
  return result;
}

FlipResult hdr_flip(const Image& x, const Image& reference, float pixels_per_degree) {
  check_sizes(x, reference);
  FlipResult result;
  const auto [start, stop] = exposure_range(reference);
  result.start_exposure = start;
  result.stop_exposure = stop;
  result.exposures = std::max(2, int(std::ceil(stop - start)));
  result.map = Image(x.width, x.height, 1);
  for (int i = 0; i < result.exposures; ++i) {
    const float scale = float(std::exp2(start + i * (stop - start) / (result.exposures - 1)));
    const auto expose = [scale](float value) { return tone_map(value, scale); };
    const Image map = flip_map(map_rgb(x, expose), map_rgb(reference, expose), pixels_per_degree);
    for (size_t p = 0; p < map.values.size(); ++p)
      result.map.values[p] = std::max(result.map.values[p], map.values[p]);
  }
  result.mean = mean_of(result.map);
  return result;
}

}  // namespace vernier
