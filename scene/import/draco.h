// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/import/accessors.h"
#include "scene/import/document.h"

namespace vernier {

/// A primitive's data out of KHR_draco_mesh_compression.
struct DracoData {
  std::vector<uint32_t> indices;
  std::map<std::string, std::vector<uint8_t>> attributes;  ///< in the component type of the accessor, packed
};

/// Decodes the primitive's compressed data. Throws Error(input) when it is damaged or does not have the
/// counts that the primitive's accessors promise. `place` is the primitive's JSON pointer.
DracoData decode_draco(const Document& document, const tinygltf::Primitive& primitive,
                       const std::string& place);

}  // namespace vernier
