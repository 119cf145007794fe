// SPDX-License-Identifier: Apache-2.0
// Any file is a scene that can be built, or is refused with an Error.

#include "scene/scene.h"
#include "tests/fuzz/scratch_file.h"
#include "vernier/error.h"
#include "vernier/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const vernier::fuzz::ScratchFile file;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const vernier::Scene scene(
        vernier::import_scene(file.write(bytes.starts_with("glTF") ? "x.glb" : "x.gltf", bytes)), {});
  } catch (const vernier::Error&) {
  }
  return 0;
}
