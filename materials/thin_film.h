// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/math.h"

namespace vernier {

/// Clear film some hundred nanometres thick on a surface, whose two reflections interfere (Belcour and Barla
/// 2017, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", with the
/// simplifications of glTF's KHR_materials_iridescence: Schlick's reflectance at both interfaces, no
/// polarisation, a base without absorption).
struct ThinFilm {
  float strength = 0;  ///< weight against the bare surface; 0: no film
  float ior = 1.3f;
  float thickness = 0;  ///< nanometres

  explicit operator bool() const { return strength > 0; }

  /// Reflectance of film and base together, seen from air; f0: of the bare base at normal incidence. In [0,
  /// 1].
  Rgb reflectance(const Rgb& f0, float cos_theta) const;
};

}  // namespace vernier
