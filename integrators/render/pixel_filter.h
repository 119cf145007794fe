// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vernier/math.h"
#include "vernier/settings.h"

namespace vernier {

/// Spreads a pixel's samples by its filter, so that their plain mean is the filtered picture (Ernst,
/// Stamminger and Greiner 2006, "Filter Importance Sampling").
class FilterSampler {
 public:
  explicit FilterSampler(const PixelFilter& filter);

  /// A position from the pixel's upper left corner, pixels; increasing in each of u, so that stratified
  /// numbers stay stratified. For the box of width 1 it is `u` itself.
  Vec2f sample(const Vec2f& u) const {
    if (integrals_.empty()) return {place(u.x), place(u.y)};
    return {place(invert(u.x)), place(invert(u.y))};
  }

  /// The pixel of a row or column for light found at a position along it, which is measured in pixels.
  struct Share {
    int pixel;
    float weight;  ///< by which the light counts there; 0: no pixel's samples reach the position
  };
  /// One of the pixels whose samples reach it, in proportion to their density: in the mean each pixel gets
  /// the light with its filter's weight, and no two get the same light.
  Share share(float position, float u) const;

 private:
  /// Density of sample() in one coordinate, at an offset from the pixel's corner.
  float density(float offset) const;
  float place(float part) const { return 0.5f + width_ * (part - 0.5f); }
  /// Which part of the width has the weight `u` before it.
  float invert(float u) const;

  float width_;
  std::vector<double> integrals_;  ///< at the ends of cells of equal width; empty: it is a box
};

/// A filter as --filter takes it: "box", "gaussian:2", "blackman-harris", or the beginning of such a name.
/// Each has a width of its own if none is said. Throws Error(usage).
PixelFilter parse_filter(std::string_view text);
/// The same from a filter, width always said.
std::string filter_text(const PixelFilter& filter);
/// Throws Error(usage) unless the width is one that PixelFilter may have.
void check_filter(const PixelFilter& filter);

/// One line of the table of filters.
struct FilterEntry {
  std::string_view name;
  PixelFilter::Kind kind;
  float width;  ///< if none is said
  std::string_view description;
};
const std::vector<FilterEntry>& filters();

}  // namespace vernier
