#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "integrators/render.h"
#include "integrators/sample_plan.h"

namespace vernier {

/// A render between two tiles: all that it takes to go on as if it had never stopped. Passes are planned
/// from what complete passes have found and are completed before the next is planned, so it does not matter
/// where a render was cut.
struct RenderState {
  static constexpr int tile_size = 16;  ///< pixels a side of what is rendered without looking up

  /// Of a picture, or crop, of which nothing is rendered yet.
  RenderState(int width, int height, bool adaptive)
      : so_far(Film(width, height)),
        guides{SampleGuide(adaptive ? width : 0, height), SampleGuide(adaptive ? width : 0, height)},
        drawn{{}, std::vector<uint32_t>(adaptive ? size_t(width) * height * Film::halves : 0)},
        light(size_t(tile_count())) {}

  int tile_columns() const { return (so_far.film.width() + tile_size - 1) / tile_size; }
  int tile_count() const { return tile_columns() * ((so_far.film.height() + tile_size - 1) / tile_size); }

  RenderResult so_far;                           ///< `reason` and `error` are not known yet
  std::array<SampleGuide, Film::halves> guides;  ///< empty without adaptive sampling
  SamplesDrawn drawn;                            ///< which samples come next
  std::vector<TileLight> light;                  ///< by tile, of the samples that all pixels get alike
  uint32_t done = 0;                             ///< samples a pixel of all complete passes
  uint32_t looked_at = 0;                        ///< `done` when the error was last looked at
  SamplePlan pass;                               ///< the one that is under way; of no samples: none is
  std::vector<uint32_t> parts;                   ///< how much of it each tile has done, in samples a pixel
};

}  // namespace vernier
