// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "vernier/math.h"

// Contract of every BSDF. Directions are unit vectors in the local frame with n = +z, both pointing away from
// the surface; wo is on the side of n (wo.z > 0). wi.z > 0 is reflection, wi.z < 0 transmission. pdf is per
// solid angle of wi. Values are for radiance carried from wi to wo; a transmitted one therefore carries the
// factor 1/eta^2.
//
//   BsdfEval eval(wo, wi) const                                  both 0 for delta lobes
//   std::optional<BsdfSample> sample(wo, u, v) const             empty: the sample carries nothing
//   Rgb diffuse(wo, wi) const                                    what of eval's f_cos a diffuse body scatters
//   Rgb albedo(wo) const                                         estimate of the fraction of light scattered
//   SpecularRays specular(wo) const                              what a Whitted ray tracer follows
//   Rgb straight(wo) const                                       fraction of light that passes undeflected,
//   as
//                                                                a delta lobe toward -wo
//   DeltaLobes delta(wo) const                                   what sample() draws of delta lobes, exactly

namespace vernier {

struct BsdfEval {
  Rgb f_cos{0, 0, 0};  ///< f |cos theta_i|
  float pdf = 0;       ///< of sample() producing wi by its non-delta lobes
};

enum class Lobe { diffuse, glossy, delta };

struct BsdfSample {
  Vec3f wi;
  Rgb weight;     ///< f |cos theta_i| / pdf
  float pdf = 0;  ///< for a delta lobe: the probability of having chosen it
  Lobe lobe = Lobe::diffuse;
  float eta = 1;  ///< index of the side entered over that left; 1 when reflected or thin

  bool is_delta() const { return lobe == Lobe::delta; }
  bool is_transmitted() const { return wi.z < 0; }
  /// Passes on in the direction it came: no event that a ray of light from beyond would notice but by its
  /// loss.
  bool is_straight() const { return is_delta() && is_transmitted() && eta == 1; }
};

/// The mirror and refraction directions of a surface, each with the fraction of light that goes that way when
/// the lobe is taken for a perfectly sharp one; weight zero where there is none.
struct SpecularRays {
  Rgb reflected{0, 0, 0};
  Rgb transmitted{0, 0, 0};
  Vec3f refracted{0, 0, -1};  ///< direction of `transmitted`
  float alpha = 0;            ///< width of the lobes taken for sharp
};

/// What the delta lobes of a surface carry, each with its choice undone: the mean of what sample() weighs it
/// with. Of dispersing glass, whose colors are bent to different sides, only what it reflects.
struct DeltaLobes {
  Rgb reflected{0, 0, 0};    ///< from reflect(wo)
  Rgb transmitted{0, 0, 0};  ///< from where light is bent to wo; with the factor 1/eta^2
  float eta = 1;             ///< as of BsdfSample, for what is transmitted

  DeltaLobes& operator*=(float part) {
    reflected *= part;
    transmitted *= part;
    return *this;
  }
};

/// wo mirrored about the normal.
inline Vec3f reflect(const Vec3f& wo) { return {-wo.x, -wo.y, wo.z}; }

}  // namespace vernier
