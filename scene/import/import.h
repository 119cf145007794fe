#pragma once

#include <string>

#include "scene/description.h"

namespace vernier {

struct ImportOptions {
  bool strict = false;  ///< anything not honoured exactly is an error
};

/// Reads a .gltf or .glb file with all it refers to. Throws Error(input) with the file and JSON pointer.
SceneDescription import_scene(const std::string& path, const ImportOptions& options = {});

}  // namespace vernier
