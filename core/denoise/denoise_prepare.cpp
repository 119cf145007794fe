// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "core/base/parallel.h"
#include "core/denoise/convolve.h"
#include "core/denoise/denoise_filters.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr float albedo_scale = 0.1f;  // albedos this far apart are different surfaces
constexpr float normal_scale = 0.3f;  // and so are normals: 17 degrees

void check(const NoisyImage& noisy) {
  const auto check_one = [&](const Image& image, const char* name, int channels = 3) {
    if (image.width == noisy.color.width && image.height == noisy.color.height && image.channels == channels)
      return;
    throw Error(ErrorKind::usage,
                fmt::format("{} of {}x{} pixels and {} channels cannot go with a picture of {}x{}; "
                            "expected {} of that size",
                            name, image.width, image.height, image.channels, noisy.color.width,
                            noisy.color.height, channels == 1 ? "one channel" : "three channels"));
  };
  check_one(noisy.color, "picture");
  if (noisy.error) check_one(*noisy.error, "error layer");
  if (noisy.albedo) check_one(*noisy.albedo, "albedo layer");
  if (noisy.normal) check_one(*noisy.normal, "normal layer");
  if (noisy.coverage) check_one(*noisy.coverage, "coverage layer", 1);
}

// Beyond the limit squares overflow; no radiance is that large.
bool is_usable(const float* rgb) {
  constexpr float limit = 1e18f;
  return std::abs(rgb[0]) < limit && std::abs(rgb[1]) < limit && std::abs(rgb[2]) < limit;
}

// Mean of the finite pixels in the smallest square about (x, y) that has any; black when the picture has
// none.
Rgb finite_mean_around(const Image& image, int x, int y) {
  for (int radius = 1; radius <= std::max(image.width, image.height); ++radius) {
    Vec3d sum(0, 0, 0);
    int count = 0;
    for (int j = std::max(0, y - radius); j <= std::min(image.height - 1, y + radius); ++j)
      for (int i = std::max(0, x - radius); i <= std::min(image.width - 1, x + radius); ++i)
        if (is_usable(image.pixel(i, j))) {
          sum += Vec3d(rgb_at(image, i, j));
          ++count;
        }
    if (count > 0) return Rgb(Vec3f(sum / count));
  }
  return {0, 0, 0};
}

void append_feature(Image& features, const Image& layer, float scale) {
  Image joined(layer.width, layer.height, features.channels + 3);
  for (int y = 0; y < layer.height; ++y)
    for (int x = 0; x < layer.width; ++x) {
      float* out = joined.pixel(x, y);
      if (features.channels > 0) out = std::copy_n(features.pixel(x, y), features.channels, out);
      for (int c = 0; c < 3; ++c) out[c] = layer.pixel(x, y)[c] / scale;
    }
  features = std::move(joined);
}

// The up to eight pixels around one.
struct Ring {
  std::array<Rgb, 8> colors;
  size_t count = 0;
  float brightest = 0;
  Rgb mean_variance{0, 0, 0};

  Ring(const Image& color, const Image& variance, int x, int y) {
    for (int j = std::max(0, y - 1); j <= std::min(color.height - 1, y + 1); ++j)
      for (int i = std::max(0, x - 1); i <= std::min(color.width - 1, x + 1); ++i) {
        if (i == x && j == y) continue;
        colors[count] = rgb_at(color, i, j);
        brightest = std::max(brightest, luminance(colors[count++]));
        mean_variance += rgb_at(variance, i, j);
      }
    if (count > 0) mean_variance /= float(count);
  }

  float median(int c) {
    const auto middle = colors.begin() + count / 2;
    std::nth_element(colors.begin(), middle, colors.begin() + count,
                     [c](const Rgb& a, const Rgb& b) { return a[c] < b[c]; });
    return (*middle)[c];
  }
};

// A pixel brighter than four times the brightest of its eight neighbors, by an excess within three standard
// errors, owes it to a few samples: it takes its neighbors' median, and the mean of their variances.
void remove_fireflies(GuidedImage& guided) {
  constexpr float outstanding = 4, errors = 3;
  const Image color = guided.color, variance = guided.variance;
  parallel_for(size_t(color.height), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < color.width; ++x) {
      Ring ring(color, variance, x, y);
      const float here = luminance(rgb_at(color, x, y));
      const float error = std::sqrt(luminance(rgb_at(variance, x, y)));
      if (ring.count == 0 || here <= outstanding * ring.brightest || here - ring.brightest > errors * error)
        continue;
      for (int c = 0; c < 3; ++c) {
        guided.color.pixel(x, y)[c] = ring.median(c);
        guided.variance.pixel(x, y)[c] = ring.mean_variance[c];
      }
    }
  });
}

// Each variance is at least the median of the 3 x 3 about it: a pixel that its samples happened to agree on,
// or that missed its light, is no surer than its neighbors. The median keeps a bright edge's noise from
// spreading.
void raise_to_median(Image& variance) {
  const Image original = variance;
  parallel_for(size_t(variance.height), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < variance.width; ++x)
      for (int c = 0; c < 3; ++c) {
        std::array<float, 9> window{};
        size_t count = 0;
        for (int j = std::max(0, y - 1); j <= std::min(variance.height - 1, y + 1); ++j)
          for (int i = std::max(0, x - 1); i <= std::min(variance.width - 1, x + 1); ++i)
            window[count++] = original.pixel(i, j)[c];
        std::nth_element(window.begin(), window.begin() + count / 2, window.begin() + count);
        float& value = variance.pixel(x, y)[c];
        value = std::max(value, window[count / 2]);
      }
  });
}

// What the colour is divided by: albedo, and for the part of a pixel that shows no surface, which a mean
// normal shorter than one tells, 1. Without normals the divisor is kept from the smallest albedos, since a
// pixel that shows a little of a dark surface has such an albedo and any colour.
Image modulation(const Image& albedo, const std::optional<Image>& normal) {
  constexpr float floor = 0.02f, floor_without_normal = 0.1f;
  Image divisor = albedo;
  for (int y = 0; y < albedo.height; ++y)
    for (int x = 0; x < albedo.width; ++x) {
      float missing = 0, least = floor_without_normal;
      if (normal) {
        missing = std::max(0.f, 1 - length(rgb_at(*normal, x, y)));
        least = floor;
      }
      for (int c = 0; c < 3; ++c) divisor.pixel(x, y)[c] = std::max(least, albedo.pixel(x, y)[c] + missing);
    }
  return divisor;
}

// Variance as a picture's second differences tell it, which smooth shading hardly has (Immerkaer 1996, "Fast
// Noise Variance Estimation"), averaged over 7 x 7 pixels.
Image estimate_variance(const Image& color) {
  constexpr std::array<float, 3> second_difference{1, -2, 1};
  constexpr float mask_energy = 36;  // sum of the squares of the mask's nine weights
  Image squares = convolve(color, second_difference, second_difference);
  for (float& value : squares.values) value *= value / mask_energy;
  const std::vector<float> box(7, 1.f / 7);
  return convolve(squares, box, box);
}

}  // namespace

Image fill_not_finite(const Image& image) {
  Image filled = image;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (is_usable(image.pixel(x, y))) continue;
      const Rgb mean = finite_mean_around(image, x, y);
      for (int c = 0; c < 3; ++c) filled.pixel(x, y)[c] = mean[c];
    }
  return filled;
}

NoisyImage made_finite(const NoisyImage& noisy) {
  check(noisy);
  const auto filled = [](const std::optional<Image>& layer) {
    return layer ? std::optional(fill_not_finite(*layer)) : std::nullopt;
  };
  return {fill_not_finite(noisy.color), filled(noisy.error), filled(noisy.albedo), filled(noisy.normal)};
}

GuidedImage prepare(const NoisyImage& given) {
  NoisyImage noisy = made_finite(given);
  GuidedImage guided;
  guided.color = std::move(noisy.color);
  guided.modulation = Image(guided.color.width, guided.color.height, 3);
  std::fill(guided.modulation.values.begin(), guided.modulation.values.end(), 1.f);
  if (noisy.albedo) {
    guided.modulation = modulation(*noisy.albedo, noisy.normal);
    for (size_t i = 0; i < guided.color.values.size(); ++i)
      guided.color.values[i] /= guided.modulation.values[i];
    append_feature(guided.features, *noisy.albedo, albedo_scale);
  }
  if (noisy.normal) append_feature(guided.features, *noisy.normal, normal_scale);
  if (noisy.error) {
    guided.variance = std::move(*noisy.error);
    for (size_t i = 0; i < guided.variance.values.size(); ++i)
      guided.variance.values[i] = square(guided.variance.values[i] / guided.modulation.values[i]);
  } else {
    guided.variance = estimate_variance(guided.color);
  }
  remove_fireflies(guided);
  raise_to_median(guided.variance);
  return guided;
}

Image keep_unexplained(Image smooth, const GuidedImage& guided) {
  constexpr float explained_errors = 2;
  for (size_t i = 0; i < smooth.values.size(); ++i) {
    const float difference = guided.color.values[i] - smooth.values[i];
    const float explained = square(explained_errors) * guided.variance.values[i];
    if (square(difference) > explained) smooth.values[i] += difference * (1 - explained / square(difference));
  }
  return smooth;
}

Image modulate(Image filtered, const GuidedImage& guided) {
  for (size_t i = 0; i < filtered.values.size(); ++i) filtered.values[i] *= guided.modulation.values[i];
  return filtered;
}

}  // namespace vernier
