// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/missing_light.h"

#include "core/compare/metrics.h"

namespace vernier {
namespace {

MissingFigure figure_of(std::span<const TileLight> tiles, Rgb MissingLight::*kind) {
  double found = 0, missing = 0, squares = 0;
  uint64_t samples = 0;
  for (const TileLight& tile : tiles) {
    const Rgb& left_out = tile.missing.*kind;
    found += luminance(tile.found);
    missing += luminance(left_out);
    samples += tile.samples;
    if (tile.samples == 0) continue;
    const auto n = double(tile.samples);
    for (int c = 0; c < 3; ++c)
      squares += n / 3 * square(left_out[c] / n) / (square(tile.found[c] / n) + relative_error_epsilon);
  }
  if (!(missing > 0)) return {};
  return {missing / (found + missing), std::sqrt(squares / double(samples))};
}

}  // namespace

MissingEstimate estimate_missing(std::span<const TileLight> tiles) {
  return {figure_of(tiles, &MissingLight::bent), figure_of(tiles, &MissingLight::depth)};
}

}  // namespace vernier
