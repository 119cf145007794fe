// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "core/film/film.h"
#include "integrators/render/camera_sample.h"
#include "integrators/render/render.h"
#include "scene/segment.h"

namespace vernier {

/// What the camera meets first, as the mean over a pixel's samples. Samples that meet nothing count as zero.
struct FirstHitMean {
  Rgb albedo{0, 0, 0};    ///< fraction of light scattered toward the camera
  Vec3f normal{0, 0, 0};  ///< of unit shading normals on the camera's side; shorter where they differ
  float coverage = 0;     ///< part of the samples that meet something
};

/// What the ray through a pixel's centre, and that of the lens, meets first.
struct FirstHit {
  float depth = 0;     ///< metres along the camera's axis; from a panorama, along the ray
  Vec3f position;      ///< world
  uint32_t instance;   ///< number in the scene
  uint32_t material;   ///< number in the scene
  uint32_t primitive;  ///< triangle of the instance
  Vec2f barycentrics;
  Vec2f uv;  ///< of the first texture coordinates that the material uses; zero where it uses none
};

/// The instances that a pixel's camera samples meet.
struct MetInstances {
  static constexpr uint32_t most_samples = 64;

  std::array<uint32_t, most_samples> instances;  ///< the first `count` are set
  uint32_t count = 0;
  uint32_t samples = 0;  ///< asked, those included that meet nothing
};

/// Looks at a picture's first hits again after it has been rendered, so that rendering never pays for them.
class FirstHits {
 public:
  /// `options` are those that `film` was rendered with. The arguments must live as long.
  FirstHits(const Scene& scene, const Camera& camera, const RenderSettings& options, const Film& film);

  /// Over the pixel's own camera samples, of each half at most the first eight, so that noise of edges is
  /// that of the picture. x and y are in the film.
  FirstHitMean mean(int x, int y) const;
  /// The same samples, of each half at most the first 32.
  MetInstances met(int x, int y) const;
  std::optional<FirstHit> at_center(int x, int y) const;
  /// Part of the lights' irradiance that nothing hides from what the samples of mean() meet; 1 where they
  /// meet nothing.
  Rgb lit(int x, int y) const;

 private:
  /// What sample i of a half meets.
  struct Met {
    Ray ray;
    Sampler sampler;
    std::optional<Interaction> hit;
  };
  Met sample(int x, int y, int half, uint32_t i) const;

  const Scene& scene_;
  const Camera& camera_;
  const RenderSettings& options_;
  const Film& film_;
  const CameraSamples camera_samples_;
};

}  // namespace vernier
