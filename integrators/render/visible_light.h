// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/film/film.h"
#include "integrators/render/render.h"

namespace vernier {

/// How well a scene shows itself to a camera, by parts of the pixels in which there is a surface; 0 where
/// there is none.
struct VisibleLight {
  /// Light from elsewhere arrives: what is scattered is at least a hundredth of what a white environment
  /// would make of the surface.
  float lit = 0;
  /// Those, and the ones that shine of themselves at least as brightly as that would make a white surface.
  float shown = 0;
  bool has_lamps = false;  ///< there are lights that no ray meets: points, spots, suns
};

/// Path traced on a coarse grid: a few thousand paths with numbers of their own, so that the answer depends
/// on the scene and the camera alone. `width` and `height` are the camera's.
VisibleLight visible_light(const Scene& scene, const Camera& camera, int width, int height);

/// Whether most of a picture would be black: light from elsewhere reaches less than a third of what the
/// camera sees, or where somebody has placed lamps less than a tenth, and less than half of it is shown at
/// all. A glowing display lights little else and leaves its model dark; a lamp in the night or over a stage
/// is meant to (rooms and streets of lamps have 0.7 to 1 of what is seen lit), and a model whose colours are
/// all emitted needs no light.
bool is_dark(const VisibleLight& light);

/// Luminance of a rendered picture over the pixels whose centres see a surface, or over all where none does;
/// a few thousand of them are looked at.
struct PictureLight {
  double mean = 0;
  double typical = 0;  ///< median of what is not in the dark
};
PictureLight picture_light(const Film& film, const Scene& scene, const Camera& camera,
                           const RenderSettings& options);

}  // namespace vernier
