// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "integrators/render/pixel_filter.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "vernier/settings.h"

namespace vernier {

/// One camera sample of a picture: its ray, the sampler with which the light along it is estimated, and what
/// the ray stands for where textures are filtered.
struct CameraSample {
  Sampler sampler;
  Ray ray;
  RayCone cone{};
};

/// Names a camera sample: its pixel in the full picture, and its number in one half of that pixel's.
struct CameraSampleId {
  int x, y, half;
  uint32_t index;
};

/// The camera samples of a picture: a pure function, so that what a sample saw can be asked again later.
class CameraSamples {
 public:
  /// `camera` must live as long; `scene` is what it looks at, and gets what is needed of filtered textures.
  CameraSamples(const Camera& camera, const Scene& scene, const RenderSettings& settings)
      : camera_(camera),
        filter_(settings.filter),
        texture_filter_(settings.texture_filter),
        width_(uint32_t(settings.width)),
        seed_(settings.seed),
        has_times_(camera.moves() || scene.moves()),
        row_exposure_(settings.row_exposure),
        rows_(float(settings.height)) {
    if (texture_filter_.is_on()) scene.make_color_mips();
  }

  /// The point of the lens comes after that of the pixel, so that a pinhole's samples are those without
  /// lenses, and the time after both, so that what stands still has those without shutters.
  /// dx, dy: as the pixel so many columns and rows away would have it.
  CameraSample get(const CameraSampleId& id, int dx = 0, int dy = 0) const {
    Sampler sampler(uint32_t(id.y) * width_ + uint32_t(id.x), id.index, 2 * seed_ + uint64_t(id.half));
    const Vec2f raster = Vec2f(float(id.x + dx), float(id.y + dy)) + filter_.sample(sampler.next2());
    CameraSample sample = at(sampler, raster, id.y + dy);
    if (texture_filter_.is_on()) sample.cone = cone(raster, id.index);
    return sample;
  }

 private:
  CameraSample at(Sampler sampler, const Vec2f& raster, int row) const {
    if (has_times_) return timed(sampler, raster, row);
    if (!camera_.has_lens()) return {sampler, camera_.ray(raster)};
    const Vec2f on_lens = sample_disk(sampler.next2());
    return {sampler, camera_.ray(raster, on_lens)};
  }

  /// The samples of a pixel share it, and the first of them do not know how many there will be: those of
  /// number n of both halves stand for an n-th of its area, as if they were the last. So what is filtered
  /// away falls as ln n / n, whatever ends the render.
  RayCone cone(const Vec2f& raster, uint32_t index) const {
    const float part = texture_filter_.width / std::sqrt(2 * float(index) + 1);
    const RayCone pixel = camera_.pixel_cone(raster);
    return {pixel.width * part, pixel.spread * part};
  }

  CameraSample timed(Sampler sampler, const Vec2f& raster, int row) const {
    std::optional<Vec2f> on_lens;
    if (camera_.has_lens()) on_lens = sample_disk(sampler.next2());
    const float opens = (1 - row_exposure_) * (float(row) + 0.5f) / rows_;
    const float time = opens + row_exposure_ * sampler.next1();
    return {sampler, camera_.ray(raster, on_lens, std::min(time, 1.f))};
  }

  const Camera& camera_;
  const FilterSampler filter_;
  const TextureFilter texture_filter_;
  const uint32_t width_;
  const uint64_t seed_;
  const bool has_times_;  ///< something moves while the shutter is open
  const float row_exposure_, rows_;
};

}  // namespace vernier
