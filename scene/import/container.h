// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace vernier {

/// The parts of a scene file: JSON text, and the binary chunk of a .glb (empty when there is none).
struct Container {
  std::span<const uint8_t> json, binary;
  bool is_glb = false;
};

/// Splits a .glb into its chunks; anything that does not start with "glTF" is taken as JSON. Throws
/// Error(input).
Container split_container(std::span<const uint8_t> file_bytes, const std::string& file);

}  // namespace vernier
