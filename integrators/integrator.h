// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/math/ray.h"
#include "core/math/ray_cone.h"
#include "core/sampling/sampler.h"
#include "integrators/light_parts.h"
#include "vernier/math.h"
#include "vernier/result.h"
#include "vernier/settings.h"

namespace vernier {

struct GradientSample;
class SmallLamps;
class SpecularChains;

/// Light that a sample knows of and leaves out, in the unit of its radiance.
struct MissingLight {
  Rgb bent{0, 0, 0};   ///< of lamps, through glass that bends it: at most this much arrives on other ways
  Rgb depth{0, 0, 0};  ///< of paths longer than the depth limit; right in the mean

  MissingLight& operator+=(const MissingLight& other) {
    bent += other.bent;
    depth += other.depth;
    return *this;
  }
};

/// One sample's answer: radiance arriving along the camera ray, W m^-2 sr^-1 in linear Rec.709 (or what
/// `--show` asks).
struct Estimate {
  Rgb radiance{0, 0, 0};
  MissingLight missing;
  RayCounts rays;
  /// Part of the light from behind all surfaces that reaches the camera straight or through clear ones, which
  /// `radiance` then leaves out; only with IntegratorOptions::background_apart.
  Rgb background{0, 0, 0};
  bool met_surface = false;  ///< by the camera ray
};

/// Which paths from lights bring light to a picture, beside what the integrator's camera samples find.
enum class LightPathKind {
  none,
  caustics,  ///< those of lamps that first meet a mirror, or glass that bends them
  all        ///< to surfaces that scatter light from there to the camera
};

/// What is known and wanted of a sample beside its ray.
struct SampleContext {
  /// About the standard deviation of the pixel's samples in the channel where it is largest, 0 if unknown:
  /// noise far below it is not worth much effort. The mean does not depend on it.
  float spread = 0;
  const LightSorter* sorter = nullptr;  ///< keeps light apart; null: nobody asks
  LightParts* parts = nullptr;          ///< where the parts of Estimate::radiance are added then
  /// What finds the light of lamps by sharp lobes that LightPathKind::caustics cannot bring; null: none of
  /// these are followed.
  const SpecularChains* chains = nullptr;
  /// Whose light to the camera is brought beside it; null: none's.
  const SmallLamps* small_lamps = nullptr;
  /// What the camera ray stands for; textures are read at points where it is the ray alone.
  RayCone cone{};
  /// Where differences to the pixels beside are told, of an integrator that wants_gradients(); null: nobody
  /// asks.
  GradientSample* gradients = nullptr;
};

/// A way to estimate the light along a camera ray. Immutable while rendering; called from many threads.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Block 0 of `sampler` belongs to the camera; the others are free.
  virtual Estimate estimate(const Scene& scene, const Ray& ray, Sampler& sampler,
                            const SampleContext& context) const = 0;

  /// What a picture of the scene needs beside camera samples.
  virtual LightPathKind light_paths(const Scene& /*scene*/) const { return LightPathKind::none; }
  /// Whether it estimates differences between pixels (SampleContext::gradients), from which a picture is
  /// reconstructed that is better than its samples.
  virtual bool wants_gradients() const { return false; }
  /// Whether it leaves out what SampleContext::small_lamps bring.
  virtual bool leaves_small_lamps() const { return false; }
};

/// One line of the table of integrators.
struct IntegratorEntry {
  std::string_view name;
  std::string_view description;
  std::unique_ptr<Integrator> (*make)(const IntegratorOptions&);
  bool splits_light = false;   ///< adds to SampleContext::parts
  bool follows_cones = false;  ///< averages textures over SampleContext::cone
};

/// All integrators (integrators/registry.cpp).
std::span<const IntegratorEntry> integrators();

/// The one of that name. Throws Error(usage) on an unknown name or something to show that there is not,
/// listing what there is, and on a depth that it cannot follow.
std::unique_ptr<Integrator> make_integrator(const std::string& name, const IntegratorOptions& options);

/// Names that raycast's IntegratorOptions::show takes.
std::span<const std::string_view> raycast_outputs();

}  // namespace vernier
