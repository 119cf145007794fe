// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <queue>

namespace vernier::test {

/// Integrals of several functions at once.
template <size_t N>
struct Integrals {
  std::array<double, N> value{};
  double error = 0;  ///< estimate: sum over cells of the largest difference between a cell and its quarters
};

/// Integrals of the N components of f(x, y) over [0,1]^2 by adaptive Gauss-Legendre cubature: the cell whose
/// value changed most when it was last quartered is quartered next, until the sum of changes is at most
/// `tolerance` or `max_evaluations` are spent. Begins with `start` x `start` cells; a feature must be wide
/// enough for one of the 36 nodes of a cell to notice it.
template <size_t N, typename Function>
Integrals<N> integrate_square(const Function& f, double tolerance, int max_evaluations = 200'000,
                              int start = 4) {
  using Rule = boost::math::quadrature::gauss<double, 6>;
  using Values = std::array<double, N>;
  struct Cell {
    double x, y, size, error;
    Values value;
    bool operator<(const Cell& other) const { return error < other.error; }
  };
  int evaluations = 0;
  const auto cell_value = [&](double x, double y, double size) {
    Values sum{};
    for (int i = 0; i < 36; ++i) {
      const int a = i / 6, b = i % 6;
      const double u = (a < 3 ? -1 : 1) * Rule::abscissa()[a % 3],
                   v = (b < 3 ? -1 : 1) * Rule::abscissa()[b % 3];
      const Values values = f(x + size * (1 + u) / 2, y + size * (1 + v) / 2);
      const double weight = Rule::weights()[a % 3] * Rule::weights()[b % 3] * size * size / 4;
      for (size_t n = 0; n < N; ++n) sum[n] += weight * values[n];
      ++evaluations;
    }
    return sum;
  };

  Integrals<N> total;
  std::priority_queue<Cell> cells;
  const auto quarter = [&](double x, double y, double size, const Values& whole) {
    Values change = whole;
    std::array<Cell, 4> parts;
    for (int i = 0; i < 4; ++i) {
      const double part_size = size / 2, left = x + (i % 2) * part_size, low = y + (i < 2 ? 0 : part_size);
      parts[i] = {left, low, part_size, 0, cell_value(left, low, part_size)};
      for (size_t n = 0; n < N; ++n) {
        total.value[n] += parts[i].value[n];
        change[n] -= parts[i].value[n];
      }
    }
    double largest = 0;
    for (const double c : change) largest = std::max(largest, std::abs(c));
    total.error += largest;
    for (Cell& part : parts) {
      part.error = largest / 4;
      cells.push(part);
    }
  };
  for (int i = 0; i < start * start; ++i) {
    const int row = i / start;
    const double size = 1.0 / start, x = (i % start) * size, y = row * size;
    quarter(x, y, size, cell_value(x, y, size));
  }
  while (total.error > tolerance && evaluations < max_evaluations) {
    const Cell worst = cells.top();
    cells.pop();
    for (size_t n = 0; n < N; ++n) total.value[n] -= worst.value[n];
    total.error -= worst.error;
    quarter(worst.x, worst.y, worst.size, worst.value);
  }
  return total;
}

struct Integral {
  double value = 0, error = 0;
};

/// The same for a function that returns one number.
template <typename Function>
Integral integrate_square(const Function& f, double tolerance, int max_evaluations = 200'000, int start = 4) {
  const auto one =
      integrate_square<1>([&](double x, double y) { return std::array<double, 1>{double(f(x, y))}; },
                          tolerance, max_evaluations, start);
  return {one.value[0], one.error};
}

}  // namespace vernier::test
