// SPDX-License-Identifier: Apache-2.0
#include "core/compare/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

// Sums over one row, so that the total does not depend on the number of threads.
struct RowSums {
  double squares = 0, relative = 0, absolute = 0;
  std::array<double, 3> mean{}, reference_mean{};
  std::array<int64_t, 3> count{};
  double largest = -1, reference_largest = -std::numeric_limits<double>::infinity();
  int largest_x = 0;
  int64_t not_finite = 0;
};

RowSums sum_row(const Image& x, const Image& reference, const Image* shown, int y) {
  RowSums sums;
  for (int column = 0; column < x.width; ++column) {
    if (shown && *shown->pixel(column, y) == 0) continue;
    for (int c = 0; c < 3; ++c) {
      const double a = x.pixel(column, y)[c], r = reference.pixel(column, y)[c];
      const int bad = !std::isfinite(a) + !std::isfinite(r);
      sums.not_finite += bad;
      if (bad) continue;
      const double error = std::abs(a - r);
      sums.squares += error * error;
      sums.relative += relative_squared(error * error, r);
      sums.absolute += error;
      sums.mean[c] += a;
      sums.reference_mean[c] += r;
      ++sums.count[c];
      sums.reference_largest = std::max(sums.reference_largest, r);
      if (error > sums.largest) {
        sums.largest = error;
        sums.largest_x = column;
      }
    }
  }
  return sums;
}

}  // namespace

double ImageDifference::psnr(double peak) const {
  return mse > 0 ? 10 * std::log10(peak * peak / mse) : std::numeric_limits<double>::infinity();
}

ImageDifference difference(const Image& x, const Image& reference, const Image* shown) {
  if (x.width != reference.width || x.height != reference.height)
    throw Error(ErrorKind::usage,
                fmt::format("pictures of {}x{} and {}x{} pixels cannot be compared; render both "
                            "in one size",
                            x.width, x.height, reference.width, reference.height));
  if (x.channels < 3 || reference.channels < 3)
    throw Error(ErrorKind::usage, "pictures to compare need three channels");
  const auto is_empty = [](const Image& mask) {
    return std::all_of(mask.values.begin(), mask.values.end(), [](float value) { return value == 0; });
  };
  if (shown && is_empty(*shown)) shown = nullptr;
  std::vector<RowSums> rows(size_t(x.height));
  parallel_for(rows.size(), [&](size_t y) { rows[y] = sum_row(x, reference, shown, int(y)); });

  ImageDifference result;
  std::array<int64_t, 3> count{};
  double largest = -1;
  result.reference_largest = -std::numeric_limits<double>::infinity();
  for (int y = 0; y < x.height; ++y) {
    const RowSums& row = rows[size_t(y)];
    result.mse += row.squares;
    result.rel_mse += row.relative;
    result.mae += row.absolute;
    result.not_finite += row.not_finite;
    result.reference_largest = std::max(result.reference_largest, row.reference_largest);
    for (int c = 0; c < 3; ++c) {
      result.mean[c] += row.mean[c];
      result.reference_mean[c] += row.reference_mean[c];
      count[c] += row.count[c];
    }
    if (row.largest > largest) {
      largest = result.largest = row.largest;
      result.largest_x = row.largest_x;
      result.largest_y = y;
    }
  }
  const int64_t total = count[0] + count[1] + count[2];
  if (total == 0) {
    result.reference_largest = 0;
    return result;
  }
  for (double* value : {&result.mse, &result.rel_mse, &result.mae}) *value /= double(total);
  for (int c = 0; c < 3; ++c) {
    result.mean[c] /= double(std::max<int64_t>(1, count[c]));
    result.reference_mean[c] /= double(std::max<int64_t>(1, count[c]));
  }
  return result;
}

}  // namespace vernier
