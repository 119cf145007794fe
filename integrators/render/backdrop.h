// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film/film.h"
#include "core/image/image_io.h"
#include "integrators/integrator.h"
#include "vernier/image.h"
#include "vernier/settings.h"

namespace vernier {

/// RenderSettings::background, ready to be seen.
class Backdrop {
 public:
  /// Of a picture as `settings` describe it. Throws Error(input) when the background's file is to be read and
  /// cannot be.
  explicit Backdrop(const RenderSettings& settings);

  /// The film keeps how much of what lies behind would show.
  bool is_transparent() const { return background_.kind == Background::Kind::transparent; }
  /// What a camera sees of this at pixel (x, y) of the full picture.
  FilmSample behind(const Estimate& estimate, int x, int y) const {
    switch (background_.kind) {
      case Background::Kind::surroundings:
        break;
      case Background::Kind::transparent:
        return {estimate.radiance, sum(estimate.background) / 3, estimate.met_surface};
      case Background::Kind::color:
        return over(estimate, background_.color);
      case Background::Kind::picture:
        return over(estimate, rgb_at(picture_, x, y));
    }
    return {estimate.radiance, 0, estimate.met_surface};
  }
  /// Text that tells the background's picture from others; empty without one.
  std::string fingerprint() const;

 private:
  static float sum(const Rgb& color) { return color.x + color.y + color.z; }
  static FilmSample over(const Estimate& estimate, const Rgb& shown) {
    return {estimate.radiance + estimate.background * shown, 0, estimate.met_surface};
  }

  Background background_;
  Image picture_;  ///< of the full picture's size
};

/// The picture in a file that is to be a background: scene-linear, and without values that a film refuses.
/// Throws Error(input).
Image read_background(const std::string& file, const ImageLimits& limits = {});

/// `options` as an integrator takes them for a picture with this background.
IntegratorOptions options_for(const Background& background, IntegratorOptions options);

/// Whether a background is what RenderSettings can have. Throws Error(usage).
void check(const Background& background);

}  // namespace vernier
