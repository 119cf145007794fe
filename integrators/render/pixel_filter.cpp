// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/pixel_filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/base/names.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// A cell of the widest filter is a fraction of a pixel that no picture shows.
constexpr size_t cells = 512;
constexpr float least_width = 0.1f, most_width = 16;
/// Where a gaussian is cut off, in standard deviations.
constexpr double gaussian_end = 3;

/// Integrals up to the part `t` of the width, from 0 to 1.
double gaussian_integral(double t) {
  const double whole = std::erf(gaussian_end / std::numbers::sqrt2);
  return 0.5 + std::erf((2 * t - 1) * gaussian_end / std::numbers::sqrt2) / (2 * whole);
}

double blackman_harris_integral(double t) {
  constexpr double a0 = 0.35875, a1 = 0.48829, a2 = 0.14128, a3 = 0.01168;
  const double angle = 2 * std::numbers::pi * t;
  const double waves = a1 * std::sin(angle) - a2 / 2 * std::sin(2 * angle) + a3 / 3 * std::sin(3 * angle);
  return t - waves / (2 * std::numbers::pi * a0);
}

}  // namespace

FilterSampler::FilterSampler(const PixelFilter& filter) : width_(filter.width) {
  if (filter.kind == PixelFilter::Kind::box) return;
  const auto integral =
      filter.kind == PixelFilter::Kind::gaussian ? gaussian_integral : blackman_harris_integral;
  for (size_t i = 0; i <= cells; ++i) integrals_.push_back(integral(double(i) / cells));
}

float FilterSampler::invert(float u) const {
  const auto upper = std::upper_bound(integrals_.begin() + 1, integrals_.end() - 1, double(u));
  const auto lower = upper - 1;
  const auto cell = double(lower - integrals_.begin());
  return float((cell + (double(u) - *lower) / (*upper - *lower)) / cells);
}

float FilterSampler::density(float offset) const {
  const float part = (offset - 0.5f) / width_ + 0.5f;
  if (!(part >= 0 && part < 1)) return 0;
  if (integrals_.empty()) return 1 / width_;
  const auto cell = size_t(part * float(cells));
  return float((integrals_[cell + 1] - integrals_[cell]) * double(cells)) / width_;
}

FilterSampler::Share FilterSampler::share(float position, float u) const {
  const float reach = (width_ - 1) / 2;
  const int first = int(std::floor(position - reach)) - 1, last = int(std::floor(position + reach)) + 1;
  float total = 0;
  for (int pixel = first; pixel <= last; ++pixel) total += density(position - float(pixel));
  float left = u * total;
  Share share{first, 0};
  for (int pixel = first; pixel <= last; ++pixel) {
    const float own = density(position - float(pixel));
    if (own > 0) share = {pixel, total};
    left -= own;
    if (left < 0) break;
  }
  return share;
}

const std::vector<FilterEntry>& filters() {
  static const std::vector<FilterEntry> table{
      {"box", PixelFilter::Kind::box, 1, "the plain mean over the pixel"},
      {"gaussian", PixelFilter::Kind::gaussian, 2, "soft; its standard deviation is a sixth of the width"},
      {"blackman-harris", PixelFilter::Kind::blackman_harris, 2.5f, "soft, and falls to nothing at its ends"},
  };
  return table;
}

PixelFilter parse_filter(std::string_view text) {
  const size_t colon = text.find(':');
  std::vector<std::string> names;
  for (const FilterEntry& filter : filters()) names.emplace_back(filter.name);
  const FilterEntry& entry =
      find_by_name(filters(), "filter", find_by_prefix("filter", text.substr(0, colon), names));
  PixelFilter filter{entry.kind, entry.width};
  if (colon == std::string_view::npos) return filter;
  const std::string_view number = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), filter.width);
  if (error != std::errc{} || end != number.data() + number.size())
    throw Error(ErrorKind::usage, fmt::format("'{}' is not a filter's width in pixels, such as {}:{}", number,
                                              entry.name, entry.width));
  check_filter(filter);
  return filter;
}

std::string filter_text(const PixelFilter& filter) {
  for (const FilterEntry& entry : filters())
    if (entry.kind == filter.kind) return fmt::format("{}:{}", entry.name, filter.width);
  return {};
}

void check_filter(const PixelFilter& filter) {
  if (!(filter.width >= least_width && filter.width <= most_width))
    throw Error(ErrorKind::usage, fmt::format("a pixel filter {} pixels wide; expected {} to {}",
                                              filter.width, least_width, most_width));
}

}  // namespace vernier
