// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "core/film/film.h"

namespace vernier {

/// Samples a pixel before any decision is taken.
constexpr uint32_t pilot = 16;

// Samples that guide and extra ones of one pixel and half come from one sequence, so that together they are
// stratified. Each kind has indices of its own: which samples a guide has seen must not depend on how many
// extra ones there were, or the luck of the half that these came from would travel with them. After the
// pilot each eight indices in a row hold two that guide, in four places by turns, and six extra ones; so an
// even share of both leaves no gap.

/// Index in the sequence of the n-th sample that guides.
constexpr uint32_t guiding_index(uint32_t n) {
  constexpr uint32_t first = pilot / 2;
  if (n < first) return n;
  const uint32_t run = (n - first) / 2;
  return first + 8 * run + 2 * (run % 4) + n % 2;
}
/// Index in the sequence of the n-th extra sample.
constexpr uint32_t extra_index(uint32_t n) {
  const uint32_t run = n / 6, place = n % 6;
  return pilot / 2 + 8 * run + (place < 2 * (run % 4) ? place : place + 2);
}

/// How many samples were drawn, accepted by the film or not.
struct SamplesDrawn {
  std::array<uint32_t, Film::halves> guiding{};  ///< of each half of every pixel, in complete passes
  std::vector<uint32_t> extra;                   ///< by pixel and half
};

/// What one half of a film has learnt from samples that every pixel gets alike; plans for the other half are
/// made from it. Were plans made from all samples, luck would travel back: a lucky half sends samples to the
/// other, whose finds send samples back to dilute the luck, while an unlucky pair keeps what it has.
class SampleStatistics {
 public:
  SampleStatistics(int width, int height) : width_(width), height_(height), cells_(size_t(width) * height) {}

  int width() const { return width_; }

  /// One thread at a time may add to a given pixel.
  void add(int x, int y, const Rgb& radiance) {
    Cell& cell = cells_[size_t(y) * width_ + x];
    cell.sum += radiance;
    cell.sum_of_squares += radiance * radiance;
    ++cell.count;
  }

  /// Standard deviation of a pixel's samples, in the channel where it is largest; 0 of fewer than two.
  float spread(int x, int y) const {
    const Cell& cell = cells_[size_t(y) * width_ + x];
    return cell.count < 2 ? 0 : std::sqrt(std::max(0.f, max_component(variance(cell))));
  }

  /// How strongly the image's relative error depends on each pixel's number of samples: the spread of a
  /// single sample over sqrt(r^2 + 0.01), root mean square over 3 x 3 pixels, since one pixel's own figure is
  /// too noisy to act on and a neighbour's surprise is a warning.
  std::vector<float> error_weights() const;
  /// What that takes: of each pixel by itself, and with its neighbors.
  static constexpr size_t error_weights_bytes_per_pixel() { return 2 * sizeof(float); }

  /// All that is known, to be stored and read back on the same kind of machine.
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(cells_)); }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
  static constexpr size_t bytes_per_pixel() { return sizeof(Cell); }
  /// Whether add() can have led to these sums, which may have overflown; false only of damaged bytes.
  bool is_plausible() const;

 private:
  struct Cell {
    Rgb sum{0, 0, 0};
    Rgb sum_of_squares{0, 0, 0};
    uint32_t count = 0;
  };
  /// Of a single sample, in each channel; needs two samples.
  static Rgb variance(const Cell& cell) {
    const auto n = float(cell.count);
    return (cell.sum_of_squares - cell.sum * cell.sum / n) / (n - 1);
  }
  static float squared_error_weight(const Cell& cell);

  int width_, height_;
  ZeroedVector<Cell> cells_;
};

/// How many samples each pixel and half gets in a pass. A pass need not be completed at once: any first part
/// of it is a plan too, spread over the picture like the whole.
class SamplePlan {
 public:
  struct Numbers {
    int width = 0;
    uint32_t size = 0;
    int odd_half = 0;              ///< which half gets the odd sample where all pixels get the same
    uint32_t guiding = 0;          ///< where they do not: what every pixel and half gets for its guide
    std::vector<uint16_t> counts;  ///< of each pixel and half; empty: all get the same
  };

  /// Of a pass: what is spread evenly, for the guides.
  static constexpr double guiding_part = 0.25;

  /// Of a pass of no samples.
  SamplePlan() = default;
  /// From what numbers() gave.
  explicit SamplePlan(Numbers numbers) : numbers_(std::move(numbers)) {}
  const Numbers& numbers() const { return numbers_; }

  /// `size` more samples for every pixel, the halves alike.
  static SamplePlan uniform(const SamplesDrawn& drawn, uint32_t size);

  /// On average `size` more samples a pixel, more where they lower the image's relative error most. The
  /// number for one half depends on the other half's guide only, and the size of the plan on neither, so that
  /// neither half's mean is biased by its own luck (Kirk and Arvo 1991, "Unbiased Sampling Techniques for
  /// Image Synthesis"). So what pixels in need cannot take goes to the others, evenly.
  static SamplePlan adaptive(const SamplesDrawn& drawn,
                             std::span<const SampleStatistics, Film::halves> guides, uint32_t size);

  /// What adaptive() takes beside its result while it runs.
  static size_t planning_bytes_per_pixel();

  /// Samples a pixel on average; 0: nothing is planned.
  uint32_t size() const { return numbers_.size; }

  /// How many samples are done when `part` a pixel, at most size(), are. Grows with `part`; at size() it is
  /// the whole plan.
  uint32_t count(int x, int y, int half, uint32_t part) const {
    if (numbers_.counts.empty()) return share(part, half);
    const size_t i = (size_t(y) * numbers_.width + x) * Film::halves + size_t(half);
    // Rounded up or down so that the total is met: by multiples of the golden ratio, whose fractions fill
    // the unit interval evenly.
    const double offset = double(uint32_t(i) * 2654435769u) * 0x1p-32;
    return uint32_t(double(numbers_.counts[i]) * part / numbers_.size + offset);
  }
  /// How many samples of the whole plan guide, the first ones of each pixel. Where all pixels get the same,
  /// these are all there are.
  uint32_t guiding_count(int half) const {
    return numbers_.counts.empty() ? share(numbers_.size, half) : numbers_.guiding;
  }

 private:
  uint32_t share(uint32_t samples, int half) const { return (samples + (half == numbers_.odd_half)) / 2; }

  Numbers numbers_;
};

}  // namespace vernier
