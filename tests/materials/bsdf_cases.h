// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "materials/bsdf.h"
#include "tests/materials/hemisphere_chart.h"

namespace vernier::test {

/// A BSDF with what is known of it. All tests of BSDFs run over bsdf_cases(), so a new model is tested by a
/// line there.
struct BsdfCase {
  std::string name;
  Bsdf bsdf;
  Bsdf reverse;      ///< the same surface seen from the other side; equal to `bsdf` when nothing passes
  double width = 1;  ///< of the narrowest lobe that eval() knows
  double eta = 1;    ///< index of the far side over the near side; 1 when nothing is bent
  double spread =
      0;  ///< of eta over the colours; the first channel, of which energy is measured, has eta itself
  bool transmits = false;
  bool lossless = false;  ///< scatters all the light it receives, to within `tolerance`
  double tolerance = 1e-3;
  double excess = 1e-4;    ///< if not lossless: how much more than all it may scatter
  bool reciprocal = true;  ///< f(wo, wi) = f(wi, wo), across the surface f / eta^2
};

std::vector<BsdfCase> bsdf_cases();

/// Directions toward the viewer from normal incidence to a cosine of 0.01, at several azimuths.
std::vector<Vec3f> outgoing_directions();

/// Unit vector of this cosine and azimuth.
Vec3f direction(float cosine, float azimuth);

/// Charts that together cover all directions into which the case scatters from wo.
std::vector<HemisphereChart> charts(const BsdfCase& bsdf_case, const Vec3f& wo);

}  // namespace vernier::test
