// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "scene/import/instances.h"
#include "scene/import/nodes.h"

namespace vernier {

/// A scene in the middle of the shutter, as far as it has been described, and what it was made by.
struct PosedDescription {
  const Document& document;
  const std::vector<ImportedMaterial>& materials;
  const ImportOptions& options;
  const std::vector<NodePose>& poses;
  const std::vector<PropertyValue>& values;  ///< animated, beyond nodes
  const NodePlaces& places;
  std::vector<MeshRequest>& requests;  ///< by mesh of the scene; may get more, as the scene may
  SceneDescription& scene;
};

/// Middle of the shutter in seconds of the animation; without a shutter, the time that the options give.
double posed_time(const ImportOptions& options);

/// Poses the file by its animation at moments of the shutter, and gives what moves as many of them as it
/// takes for it to be followed to a thousandth of its size, from 2 to most_moments. What is at the same place
/// a quarter, half and three quarters through as at both ends is taken to stand still. What appears, vanishes
/// or changes otherwise is left as it is in the middle, which is noticed. Throws Error(input).
void add_moments(const PosedDescription& posed);

}  // namespace vernier
