// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/film/film.h"
#include "core/film/screened_poisson.h"

namespace vernier {

/// The pixels beside one, in the order in which differences to them are kept: right, left, below, above.
struct PixelNeighbors {
  static constexpr size_t count = 4;
  static constexpr std::array<int, count> dx{1, -1, 0, 0}, dy{0, 0, 1, -1};
};

/// Beside a film, what its samples tell of the differences between neighboring pixels: sums in double by
/// pixel and half. A difference has two sides, and each pixel keeps its own, over its own samples: then
/// pixels may have any numbers of samples, and one thread at a time adds to a pixel.
class GradientFilm {
 public:
  using Differences = std::array<Rgb, PixelNeighbors::count>;

  /// Of no pixels.
  GradientFilm() = default;
  GradientFilm(int width, int height) : width_(width), cells_(size_t(width) * height * Film::halves) {}

  bool empty() const { return cells_.empty(); }

  /// Of a sample that the film has taken: its part that no difference tells of, and its side of the
  /// differences to the neighbors, neighbor less pixel.
  void add(int x, int y, int half, const Rgb& primal_only, const Differences& differences) {
    Cell& cell = cells_[(size_t(y) * width_ + x) * Film::halves + half];
    cell.primal_only += Vec3d(primal_only);
    for (size_t i = 0; i < differences.size(); ++i) cell.differences[i] += Vec3d(differences[i]);
  }

  /// Gives each half of `film`, of the same size and samples, the picture that fits to its pixels and to its
  /// differences. Each is made from that half alone by a fixed linear function that leaves right pictures as
  /// they are: the mean stays right, and the halves independent.
  void reconstruct(Film& film) const;

  /// All that is known, to be stored and read back by the same version on the same kind of machine.
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(cells_)); }
  std::span<std::byte> bytes() { return std::as_writable_bytes(std::span(cells_)); }
  static constexpr size_t bytes_per_pixel() { return Film::halves * sizeof(Cell); }
  /// Memory that a reconstruction takes while it runs, beside what it leaves in the film.
  static constexpr size_t reconstruction_bytes_per_pixel() { return screened_poisson_bytes_per_pixel(); }
  bool is_plausible() const;
  /// Adds the sums of another one of the same size.
  void merge(const GradientFilm& other);

 private:
  struct Cell {
    Vec3d primal_only{0, 0, 0};
    std::array<Vec3d, PixelNeighbors::count> differences{Vec3d(0), Vec3d(0), Vec3d(0), Vec3d(0)};
  };

  int width_ = 0;
  ZeroedVector<Cell> cells_;
};

}  // namespace vernier
