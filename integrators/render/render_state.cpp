// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/render_state.h"

#include <algorithm>
#include <numeric>

namespace vernier {
namespace {

bool is_plausible(const ConvergencePoint& look) {
  constexpr double most = 1e10;  // seconds are three centuries
  const auto is_within = [](double value) { return value >= 0 && value <= most; };
  return is_within(look.seconds) && is_within(look.samples_per_pixel) && is_within(look.error.unreliable);
}

bool is_plausible(const BadSample& bad) {
  return bad.x >= 0 && bad.y >= 0 && (bad.half == 0 || bad.half == 1) &&
         bad.index <= 2 * RenderState::most_samples;
}

uint64_t accepted_samples(const Film& film) {
  uint64_t sum = 0;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x)
      for (int half = 0; half < Film::halves; ++half) sum += film.samples(x, y, half);
  return sum;
}

}  // namespace

void reconstruct(RenderState& state) {
  if (state.gradients.empty() || state.reconstructed_samples == state.partial.samples) return;
  state.gradients.reconstruct(state.partial.film);
  state.reconstructed_samples = state.partial.samples;
}

ErrorEstimate estimate_error(RenderState& state) {
  reconstruct(state);
  return estimate_error(state.partial.film);
}

MissingEstimate estimate_missing(std::vector<TileLight> tiles, const Film& film) {
  constexpr int size = RenderState::tile_size;
  const int columns = (film.width() + size - 1) / size;
  const auto& of_halves = film.light_paths();
  const uint64_t paths = std::accumulate(of_halves.begin(), of_halves.end(), uint64_t{0});
  for (size_t i = 0; film.has_splats() && i < tiles.size(); ++i) {
    const int x0 = int(i) % columns * size, y0 = int(i) / columns * size;
    const int x1 = std::min(x0 + size, film.width()), y1 = std::min(y0 + size, film.height());
    Vec3d sum(0, 0, 0);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (int half = 0; half < Film::halves; ++half) sum += film.splat_mean(x, y, half) / Film::halves;
    const double samples_per_pixel = double(tiles[i].samples) / ((x1 - x0) * (y1 - y0));
    tiles[i].found += Rgb(Vec3f(sum * samples_per_pixel));
    if (paths > 0) tiles[i].missing.depth += tiles[i].beyond * float(samples_per_pixel / double(paths));
  }
  return estimate_missing(tiles);
}

const char* implausible_part(const RenderState& state) {
  const RenderResult& partial = state.partial;
  const auto all = [](const auto& values, const auto& holds) {
    return std::all_of(values.begin(), values.end(), holds);
  };
  if (!partial.film.is_plausible() || accepted_samples(partial.film) + partial.bad_samples != partial.samples)
    return "film";
  if (!state.gradients.is_plausible()) return "gradients";
  for (const LightFilm& part : partial.light)
    if (!part.film.is_plausible()) return part.layer.c_str();
  if (!state.guides[0].is_plausible()) return "guide 1";
  if (!state.guides[1].is_plausible()) return "guide 2";
  const auto is_count = [](uint32_t count) { return count <= RenderState::most_samples; };
  if (!all(state.drawn.guiding, is_count) || !all(state.drawn.extra, is_count)) return "extra";
  if (!all(state.light, [](const TileLight& light) { return light.is_plausible(); })) return "light";
  if (!all(state.tile_progress, [&](uint32_t part) { return part <= state.pass.size(); })) return "parts";
  if (!all(partial.convergence, [](const auto& look) { return is_plausible(look); })) return "looks";
  if (!all(partial.bad_sample_examples, [](const auto& bad) { return is_plausible(bad); }))
    return "bad samples";
  return nullptr;
}

}  // namespace vernier
