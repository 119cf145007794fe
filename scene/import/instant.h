// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/import/moments.h"

namespace vernier {

/// The file at one moment.
struct Instant {
  NodePlaces places;
  Placement placement;
  SceneDescription seen;  ///< cameras and lights
  bool changes = false;   ///< what is no motion
};

/// At so many seconds of its animation. What shows is what shows in the middle of the shutter.
Instant instant_at(const PosedDescription& posed, double seconds);

/// Corners of triangles instead of vertices, since which of them share one may differ from moment to moment.
void separate_corners(MeshDescription& mesh);

}  // namespace vernier
