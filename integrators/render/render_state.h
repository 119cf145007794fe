// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/film/gradient_film.h"
#include "integrators/render/render.h"
#include "integrators/render/sample_plan.h"

namespace vernier {

/// A render between two tiles: all that it takes to go on as if it had never stopped. Passes are planned
/// from what complete passes have found and are completed before the next is planned, so it does not matter
/// where a render was cut.
struct RenderState {
  static constexpr int tile_size = 16;  ///< pixels a side; limits are checked between tiles

  /// More samples a pixel than any render takes, and few enough for an int to hold twice as many.
  static constexpr uint32_t most_samples = 1 << 30;

  /// Of a picture, or crop, of which nothing is rendered yet.
  RenderState(int width, int height, bool adaptive, bool has_alpha = false,
              std::span<const std::string> light_layers = {}, bool has_splats = false,
              bool has_gradients = false)
      : partial(Film(width, height, has_alpha, has_splats)),
        guides{SampleStatistics(adaptive ? width : 0, height),
               SampleStatistics(adaptive ? width : 0, height)},
        drawn{{}, std::vector<uint32_t>(adaptive ? size_t(width) * height * Film::halves : 0)},
        light(size_t(tile_count())) {
    if (has_gradients) gradients = GradientFilm(width, height);
    for (const std::string& layer : light_layers)
      partial.light.push_back({layer, Film(width, height, false, has_splats)});
  }

  /// Of a picture, or crop, of this size.
  static int tile_count(int width, int height) {
    return ((width + tile_size - 1) / tile_size) * ((height + tile_size - 1) / tile_size);
  }
  int tile_columns() const { return (partial.film.width() + tile_size - 1) / tile_size; }
  /// The tile of a pixel.
  int tile_of(int x, int y) const { return y / tile_size * tile_columns() + x / tile_size; }
  int tile_count() const { return tile_count(partial.film.width(), partial.film.height()); }

  static constexpr size_t bytes_per_pixel(bool adaptive, bool has_alpha, size_t light_layers = 0,
                                          bool has_splats = false, bool has_gradients = false) {
    // Guides, the plan, and which samples come next.
    const size_t guiding =
        Film::halves * (SampleStatistics::bytes_per_pixel() + sizeof(uint16_t) + sizeof(uint32_t));
    const size_t splats = has_splats ? Film::splat_bytes_per_pixel() : 0;
    return (1 + light_layers) * (Film::bytes_per_pixel() + splats) +
           (has_alpha ? Film::alpha_bytes_per_pixel() : 0) + (adaptive ? guiding : 0) +
           (has_gradients ? GradientFilm::bytes_per_pixel() : 0);
  }
  /// Whether a render of a picture, or crop, of this size can go on from it.
  bool fits(int width, int height, bool adaptive, bool has_alpha,
            std::span<const std::string> light_layers = {}, bool has_splats = false,
            bool has_gradients = false) const {
    return std::equal(partial.light.begin(), partial.light.end(), light_layers.begin(), light_layers.end(),
                      [](const LightFilm& part, const std::string& layer) { return part.layer == layer; }) &&
           partial.film.width() == width && partial.film.height() == height &&
           partial.film.has_alpha() == has_alpha && partial.film.has_splats() == has_splats &&
           guides[0].bytes().empty() == !adaptive && gradients.empty() == !has_gradients;
  }

  RenderResult partial;                               ///< `reason` and `error` are not known yet
  std::array<SampleStatistics, Film::halves> guides;  ///< empty without adaptive sampling
  SamplesDrawn drawn;                                 ///< which samples come next
  GradientFilm gradients;                             ///< of integrators that estimate them; else empty
  uint64_t reconstructed_samples = 0;                 ///< of which the film's correction is made
  std::vector<TileLight> light;                       ///< by tile, of the samples that all pixels get alike
  uint32_t completed_spp = 0;                         ///< samples a pixel of all complete passes
  uint32_t last_checked_spp = 0;                      ///< `completed_spp` when the error was last estimated
  SamplePlan pass;                                    ///< the one that is under way; of no samples: none is
  std::vector<uint32_t> tile_progress;  ///< how much of it each tile has done, in samples a pixel
  uint64_t light_batches = 0;           ///< of light paths (render/light_pass.h) that are done
};

/// Where there are gradients, brings the film up to date with its samples: the correction that it has is of
/// those that there were when it was last made.
void reconstruct(RenderState& state);
/// The error of what there is, reconstructed first.
ErrorEstimate estimate_error(RenderState& state);

/// Of tiles whose samples are spread evenly over their pixels, to which the light paths of a film add theirs.
MissingEstimate estimate_missing(std::vector<TileLight> tiles, const Film& film);

/// The name of a part of a state, as checkpoints call it, whose values no render can have led to and which
/// might be indexed out of bounds, never come to an end, or give undefined numbers; null where there is none.
const char* implausible_part(const RenderState& state);

}  // namespace vernier
