// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "integrators/render/picture.h"
#include "vernier/error.h"
#include "vernier/picture.h"

namespace vernier {
namespace {

constexpr Metric table[] = {
    {"mse", "mean (x-r)^2", [](const Comparison& c) { return std::optional(c.difference.mse); }},
    {"rmse", "its square root", [](const Comparison& c) { return std::optional(c.difference.rmse()); }},
    {"relmse", "mean (x-r)^2 / (r^2 + 0.01)",
     [](const Comparison& c) { return std::optional(c.difference.rel_mse); }},
    {"mae", "mean |x-r|", [](const Comparison& c) { return std::optional(c.difference.mae); }},
    {"psnr", "decibels", [](const Comparison& c) { return std::optional(c.difference.psnr(c.peak)); }},
    {"largest", "max |x-r|", [](const Comparison& c) { return std::optional(c.difference.largest); }},
    {"not_finite", "values that are NaN or infinite, left out of the above",
     [](const Comparison& c) { return std::optional(double(c.difference.not_finite)); }},
    {"alpha", "root mean square difference of alpha", [](const Comparison& c) { return c.alpha; }},
    {"flip", "mean perceived difference, 0 to 1",
     [](const Comparison& c) { return c.flip ? std::optional(c.flip->mean) : std::nullopt; }},
    {"differing", "blocks of pixels whose expectations differ, by both error layers",
     [](const Comparison& c) { return c.bias ? std::optional(double(c.bias->differing)) : std::nullopt; }},
    {"mean_p", "probability of means this far apart by chance, by both error layers",
     [](const Comparison& c) { return c.bias ? std::optional(c.bias->mean_p) : std::nullopt; }},
};

/// Degrees of freedom of a file's error layer: a pixel's samples less the means of the two halves.
double error_degrees(const Metadata& metadata) {
  const auto samples = metadata.find("vernier:samplesPerPixel");
  double count = 0;
  if (samples != metadata.end()) {
    const std::string& text = samples->second;
    std::from_chars(text.data(), text.data() + text.size(), count);
  }
  return count > 2 ? std::max(1.0, count - 2) : std::numeric_limits<double>::infinity();
}

/// What the bias test asks of a file.
struct MeasuredFile {
  const Image& mean;
  std::optional<Image> error, unreliable;
  double degrees;
  bool denoised, reconstructed;

  MeasuredFile(const LayeredImage& file, const Image& rgb)
      : mean(rgb),
        error(file.layer("error")),
        unreliable(file.single("error.unreliable")),
        degrees(error_degrees(file.metadata)),
        denoised(file.metadata.contains("vernier:denoiser")),
        reconstructed(file.metadata.contains("vernier:reconstruction")) {}
  MeasuredImage image() const {
    return {mean, *error, degrees, unreliable ? &*unreliable : nullptr, denoised || reconstructed};
  }
};

/// One channel, 0 where neither picture shows a surface; none when neither tells.
std::optional<Image> shown_pixels(const LayeredImage& x, const LayeredImage& r) {
  auto shown = coverage_of(x);
  auto other = coverage_of(r);
  if (!shown) return other;
  if (other && other->values.size() == shown->values.size())
    for (size_t i = 0; i < shown->values.size(); ++i)
      shown->values[i] = std::max(shown->values[i], other->values[i]);
  return shown;
}

double part_above_zero(const Image& image) {
  const auto above = std::count_if(image.values.begin(), image.values.end(), [](float v) { return v > 0; });
  return double(above) / double(image.values.size());
}

/// Of two pictures of one channel and one size.
double root_mean_square(const Image& x, const Image& r) {
  double sum = 0;
  for (size_t i = 0; i < x.values.size(); ++i) sum += square(double(x.values[i]) - double(r.values[i]));
  return std::sqrt(sum / double(x.values.size()));
}

}  // namespace

std::span<const Metric> metrics() { return table; }

Comparison compare(const NamedPicture& picture, const NamedPicture& reference,
                   const ComparisonOptions& options) {
  const LayeredImage &x = picture.picture, &r = reference.picture;
  if (x.linear != r.linear)
    throw Error(ErrorKind::usage, fmt::format("{} holds {} and {} {}; compare pictures of one kind",
                                              picture.name, x.linear ? "linear light" : "display values",
                                              reference.name, r.linear ? "linear light" : "display values"));
  if (x.place.x != r.place.x || x.place.y != r.place.y || x.place.full_width != r.place.full_width ||
      x.place.full_height != r.place.full_height)
    throw Error(ErrorKind::usage,
                fmt::format("{} and {} are different parts of pictures; compare the same part", picture.name,
                            reference.name));
  const auto x_alpha = alpha_of(x), r_alpha = alpha_of(r);
  if (x_alpha.has_value() != r_alpha.has_value())
    throw Error(
        ErrorKind::usage,
        fmt::format("{} has alpha and {} has none; compare pictures of one kind, 'develop "
                    "--background' puts something behind a transparent one",
                    x_alpha ? picture.name : reference.name, x_alpha ? reference.name : picture.name));
  const Image x_rgb = x.rgb(), r_rgb = r.rgb();
  Comparison result;
  result.width = r.image.width;
  result.height = r.image.height;
  result.linear = r.linear;
  const auto shown = shown_pixels(x, r);
  result.difference = difference(x_rgb, r_rgb, shown ? &*shown : nullptr);
  if (shown) result.shown = part_above_zero(*shown);
  if (x_alpha) result.alpha = root_mean_square(*x_alpha, *r_alpha);
  result.peak = r.linear ? result.difference.reference_largest : 1;
  if (options.flip) result.flip = r.linear ? hdr_flip(x_rgb, r_rgb) : flip(x_rgb, r_rgb);
  const MeasuredFile x_measured(x, x_rgb), r_measured(r, r_rgb);
  result.denoised = x_measured.denoised || r_measured.denoised;
  if (x_measured.error && r_measured.error)
    result.bias = test_bias(x_measured.image(), r_measured.image(), options.bias_level, options.bias_block);
  return result;
}

std::map<std::string, double> compare(const LayeredImage& picture, const LayeredImage& reference) {
  const Comparison comparison = compare({"the picture", picture}, {"its reference", reference}, {});
  std::map<std::string, double> figures;
  for (const Metric& metric : table)
    if (const auto value = metric.value(comparison)) figures.emplace(metric.name, *value);
  return figures;
}

}  // namespace vernier
