// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>

#include "scene/description.h"

namespace vernier {

struct ImportOptions {
  bool strict = false;  ///< anything not honoured exactly is an error
  std::string variant;  ///< of KHR_materials_variants, by name; empty: the materials the file has without
  /// Seconds at which an animation poses the scene. None: the scene is at rest, unless `animation` is named,
  /// which then poses it at 0.
  std::optional<double> time;
  /// Name, index, or "all" of them at once; empty: all when no two set the same thing, else the first.
  std::string animation;
  /// Files that the scene refers to may lie outside its folder; such a reference is an error otherwise.
  bool allow_outside_files = false;
};

/// Reads a .gltf or .glb file with all it refers to. Throws Error(input) with the file and JSON pointer, and
/// Error(usage) on a variant or an animation that the file has not.
SceneDescription import_scene(const std::string& path, const ImportOptions& options = {});

/// Throws Error(input) for the first warning about the scene file: what `strict` means to notices that come
/// up only when the scene is built.
void refuse_warnings(const std::string& path, std::span<const Notice> notices);

}  // namespace vernier
