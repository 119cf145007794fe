#pragma once

#include <span>
#include <vector>

#include "core/image/film.h"

namespace vernier {

/// What one half of a film has learnt from samples that every pixel gets alike; plans for the other half are
/// made from it. Were plans made from all samples, luck would travel back: a lucky half sends samples to the
/// other, whose finds send samples back to dilute the luck, while an unlucky pair keeps what it has.
class SampleGuide {
 public:
  SampleGuide(int width, int height) : width_(width), height_(height), cells_(size_t(width) * height) {}

  /// One thread at a time may add to a given pixel.
  void add(int x, int y, const Rgb& radiance) {
    Cell& cell = cells_[size_t(y) * width_ + x];
    cell.sum += radiance;
    cell.sum_of_squares += radiance * radiance;
    ++cell.count;
  }

  /// How strongly the image's relative error depends on each pixel's number of samples: the spread of a
  /// single sample over sqrt(r^2 + 0.01), root mean square over 3 x 3 pixels, since one pixel's own figure is
  /// too noisy to act on and a neighbour's surprise is a warning.
  std::vector<float> needs() const;

 private:
  struct Cell {
    Rgb sum{0, 0, 0};
    Rgb sum_of_squares{0, 0, 0};
    uint32_t count = 0;
  };
  static float squared_need(const Cell& cell);

  int width_, height_;
  std::vector<Cell> cells_;
};

/// How many samples each pixel and half gets in the next pass.
class SamplePlan {
 public:
  /// `count` more samples for every pixel, the halves alike.
  static SamplePlan uniform(const Film& film, uint32_t count);

  /// On average `count` more samples a pixel, more where they lower the image's relative error most; a
  /// quarter of them is spread evenly, for the guides. The number for one half depends on the other half's
  /// guide only, so that neither half's mean is biased by its own luck (Kirk and Arvo 1991, "Unbiased
  /// Sampling Techniques for Image Synthesis").
  static SamplePlan adaptive(const Film& film, std::span<const SampleGuide, Film::halves> guides,
                             uint32_t count);

  uint32_t count(int x, int y, int half) const {
    return counts_.empty() ? even_[half] : counts_[(size_t(y) * width_ + x) * Film::halves + half];
  }
  /// How many of count() every pixel gets: those that may go into a guide.
  uint32_t even_count(int half) const { return even_[half]; }

 private:
  int width_ = 0;
  uint32_t even_[Film::halves] = {0, 0};
  std::vector<uint16_t> counts_;  ///< empty: even_ everywhere
};

}  // namespace vernier
