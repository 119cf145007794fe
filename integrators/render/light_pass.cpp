// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/light_pass.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace vernier {
namespace {

/// Batches for a thread before a render looks up again.
constexpr uint64_t batches_per_thread = 4;
/// Rows of pixels that one thread adds to, of whole tiles; each looks through all splats.
constexpr int rows_per_band = 2 * RenderState::tile_size;

int half_of(uint64_t batch) { return int(batch % Film::halves); }

}  // namespace

void LightPass::advance(RenderState& state, uint64_t end) const {
  const uint64_t first = state.light_batches;
  std::vector<Caught> batches(size_t(std::min(end - first, batches_per_thread * thread_count())));
  parallel_for(batches.size(), [&](size_t i) {
    const uint64_t batch = first + i;
    for (uint64_t path = 0; path < batch_size; ++path)
      paths_.trace({batch / Film::halves * batch_size + path, half_of(batch)}, batches[i]);
  });
  add(state, batches);
  state.light_batches += batches.size();
}

void LightPass::add(RenderState& state, const std::vector<Caught>& batches) const {
  RenderResult& result = state.partial;
  const int height = result.film.height();
  parallel_for(size_t((height + rows_per_band - 1) / rows_per_band), [&](size_t band) {
    for (size_t batch = 0; batch < batches.size(); ++batch) {
      const int half = half_of(state.light_batches + batch);
      const std::vector<Splat>& splats = batches[batch].splats;
      for (size_t i = 0; i < splats.size(); ++i) {
        const auto& [x, y, radiance, is_beyond] = splats[i];
        if (y / rows_per_band != int(band)) continue;
        if (is_beyond) {
          state.light[size_t(state.tile_of(x, y))].beyond += radiance;
          continue;
        }
        result.film.splat(x, y, half, radiance);
        for (size_t layer = 0; layer < result.light.size(); ++layer)
          result.light[layer].film.splat(x, y, half, sorter_->part(batches[batch].parts[i], layer));
      }
    }
  });
  count_paths(result, state.light_batches, state.light_batches + batches.size());
  for (const Caught& caught : batches) {
    result.rays += caught.rays;
    result.bad_light_paths += caught.rejected;
  }
}

void LightPass::count_paths(RenderResult& result, uint64_t first, uint64_t end) {
  for (uint64_t half = 0; half < Film::halves; ++half) {
    const uint64_t batches = (end + 1 - half) / Film::halves - (first + 1 - half) / Film::halves;
    result.film.count_light_paths(int(half), batches * batch_size);
    for (LightFilm& part : result.light) part.film.count_light_paths(int(half), batches * batch_size);
  }
}

}  // namespace vernier
