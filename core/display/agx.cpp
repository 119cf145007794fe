// SPDX-License-Identifier: Apache-2.0
#include "core/display/agx.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vernier {
namespace {

using Matrix = std::array<std::array<float, 3>, 3>;  // rows

// Linear Rec.709 to Rec.2020 and back (ITU-R BT.2087-0).
constexpr Matrix to_rec2020{
    {{0.6274f, 0.3293f, 0.0433f}, {0.0691f, 0.9195f, 0.0114f}, {0.0164f, 0.0880f, 0.8956f}}};
constexpr Matrix to_rec709{
    {{1.6605f, -0.5877f, -0.0728f}, {-0.1246f, 1.1330f, -0.0084f}, {-0.0182f, -0.1006f, 1.1188f}}};

// Moves the primaries toward white, so that bright light loses its color before it is clipped; the outset, of
// other primaries, gives some of it back.
constexpr Matrix inset{{{0.856627153f, 0.0951212405f, 0.0482516061f},
                        {0.137318973f, 0.761241991f, 0.101439036f},
                        {0.111898213f, 0.0767994186f, 0.811302368f}}};
constexpr Matrix outset{{{1.12710058f, -0.110606643f, -0.0164939387f},
                         {-0.141329763f, 1.15782370f, -0.0164939387f},
                         {-0.141329763f, -0.110606643f, 1.25193641f}}};

std::array<float, 3> times(const Matrix& m, const std::array<float, 3>& v) {
  std::array<float, 3> product{};
  for (size_t row = 0; row < 3; ++row) product[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
  return product;
}

/// A curve that rises from (0, 0) through the pivot, there with this slope, to (1, 1). Beyond the pivot and
/// before it it is u / (1 + u^p)^(1/p) in units that let it end in the corner.
float contrast(float x) {
  constexpr float pivot_x = 10 / 16.5f, pivot_y = 0.5f, slope = 2;
  const bool is_toe = x < pivot_x;
  const float power = is_toe ? 3.0f : 3.25f;
  const float width = is_toe ? pivot_x : 1 - pivot_x, height = is_toe ? pivot_y : 1 - pivot_y;
  const float unit = slope * width / std::pow(std::pow(slope * width / height, power) - 1, 1 / power);
  const float u = slope * std::abs(x - pivot_x) / unit;
  const float rise = unit * u / std::pow(1 + std::pow(u, power), 1 / power);
  return is_toe ? pivot_y - rise : pivot_y + rise;
}

}  // namespace

void agx(float* rgb) {
  // Stops about middle grey, 10 below and 6.5 above.
  const float lowest = std::log2(0.18f) - 10, stops = 16.5f;
  std::array<float, 3> color = times(inset, times(to_rec2020, {rgb[0], rgb[1], rgb[2]}));
  for (float& c : color)
    c = contrast(std::clamp((std::log2(std::max(c, 1e-10f)) - lowest) / stops, 0.0f, 1.0f));
  color = times(outset, color);
  for (float& c : color) c = std::pow(std::max(c, 0.0f), 2.2f);
  color = times(to_rec709, color);
  std::copy(color.begin(), color.end(), rgb);
}

}  // namespace vernier
