// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/export.h"
#include "vernier/scene.h"

namespace vernier {

enum class GroundKind {
  matte,
  shadow  ///< matt too, but a camera sees of it the shadow alone: MaterialDescription::catches_shadow
};

/// Puts a level ground under a scene as it stands: a matt grey square, reflectance 0.5, that lies just below
/// the lowest point of what the scene is of (surroundings that are far larger than the rest do not count),
/// reaches out a hundred times as far, and is not there for a camera that looks from below. A scene in which
/// there is nothing to see stays as it is.
VERNIER_API void add_ground(SceneDescription& description, GroundKind kind = GroundKind::matte);

}  // namespace vernier
