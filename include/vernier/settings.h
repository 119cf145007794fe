// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vernier/image.h"
#include "vernier/scene.h"

namespace vernier {

/// Which technique finds light: both weighted against each other, or one alone, for study and for tests.
enum class LightSampling { mis, light, bsdf };

/// Whether paths from lamps bring what reaches a surface by mirrors and through glass that bends it, which no
/// path from the camera finds. Automatic: where a lamp of the scene shines on such surfaces.
enum class Caustics { automatic, on, off };

/// What can be said of any integrator; each reads what it knows.
struct IntegratorOptions {
  int max_depth = 16;                                 ///< path vertices after the camera
  LightSampling light_sampling = LightSampling::mis;  ///< path
  bool russian_roulette = true;                       ///< path, gradient, light
  Caustics caustics = Caustics::automatic;            ///< path, gradient
  std::string show = "normal";                        ///< raycast: what to show
  float ambient = 0.05f;                              ///< whitted: constant ambient radiance
  float cutoff = 1e-3f;  ///< whitted: a recursive ray that would contribute less than this is not traced
  /// What the camera sees behind all surfaces, straight or through clear ones, is no part of the light but is
  /// told apart from it. A session sets it by RenderSettings::background.
  bool background_apart = false;
};

/// What the camera sees behind all surfaces, straight or through clear ones. Only the surroundings light the
/// scene and are mirrored in it.
struct Background {
  enum class Kind { surroundings, transparent, color, picture };
  Kind kind = Kind::surroundings;
  Rgb color{0, 0, 0};  ///< scene-linear Rec.709
  /// Of a picture, which fills the whole frame, centred, cut where its shape is another. Eight- and
  /// sixteen-bit files hold sRGB values, others scene-linear ones.
  std::string file = {};
  /// What `file` holds, where that is at hand: scene-linear, of three channels, finite and not negative.
  /// Null: a session reads it. Not in to_json().
  std::shared_ptr<const Image> picture = nullptr;
};

/// Pixels [x, x + width) x [y, y + height) of the full picture.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

/// When to stop: at whichever comes first. They count from the beginning of a render, however often it was
/// interrupted.
struct RenderLimits {
  int spp = 64;                                              ///< samples a pixel on average; 0: no limit
  double seconds = std::numeric_limits<double>::infinity();  ///< of rendering
  /// Relative RMSE of the picture (ErrorEstimate), once the end of its interval is at most a tenth above;
  /// 0: none.
  double error = 0;
};

/// By what weight a pixel shows what lies around its centre: the product of a function of x and one of y. The
/// samples are spread by it, so each belongs to one pixel and pixels stay independent of each other.
struct PixelFilter {
  /// A gaussian is cut off at three standard deviations. Blackman-Harris is the window of Harris 1978 ("On
  /// the Use of Windows for Harmonic Analysis with the Discrete Fourier Transform"), four terms.
  enum class Kind { box, gaussian, blackman_harris };
  Kind kind = Kind::box;
  float width = 1;  ///< pixels from one end to the other, 0.1 to 16
};

/// Whether textures of colours are averaged over what a camera sample stands for before they are shaded,
/// rather than read at its point: an approximation, as light need not be proportional to a colour, and blurs
/// the picture by as much again as a pixel does. It becomes exact as samples grow: the n-th sample of a pixel
/// stands for a square of `width` / sqrt(n) pixels a side. Where the camera looks directly, through clear
/// surfaces and by mirrors; coverage, normals and all that shapes a lobe are read at the point.
struct TextureFilter {
  enum class Kind { none, mip };
  Kind kind = Kind::none;
  float width = 1;  ///< pixels, 0.1 to 16

  bool is_on() const { return kind != Kind::none; }
};

/// Lights whose part of a picture is kept apart.
struct LightGroup {
  std::string name;
  /// Names of punctual lights, of nodes or materials that emit, or "environment".
  std::vector<std::string> lights;
};

/// What parts of a picture's light are kept apart, each with its own error; the integrator must be "path".
struct LightSplit {
  /// By the way light comes to the camera: names of layers, "diffuse_direct".
  std::vector<std::string> ways;
  /// By its source; light of two groups goes to the first, and that of none to one more, "rest".
  std::vector<LightGroup> groups;
};

/// All that a picture depends on beside its scene, and when to stop.
struct VERNIER_API RenderSettings {
  int width = 0, height = 0;  ///< of the full picture, pixels
  Crop crop;                  ///< what is rendered; zero width: everything
  CameraDescription camera;
  PixelFilter filter;
  TextureFilter texture_filter;
  Background background;
  std::string integrator = "path";
  IntegratorOptions integrator_options;
  LightSplit light_split;
  /// Part of the shutter for which each row of the picture is exposed: the first from its opening on, the
  /// last until its closing, as in cameras that read their rows one after the other; 1: all rows throughout.
  float row_exposure = 1;
  bool adaptive = true;  ///< spend samples where they lower the picture's error
  uint64_t seed = 0;
  RenderLimits limits;

  /// As JSON, and back. Throws Error(input) on what is no settings of this version.
  std::string to_json() const;
  static RenderSettings from_json(std::string_view text);
};

}  // namespace vernier
