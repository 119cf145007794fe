// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/import/document.h"

namespace vernier {

/// A buffer view's EXT_meshopt_compression or KHR_meshopt_compression, by the names of their specifications.
/// The bit streams are one family, so what can be decoded depends on the library alone.
struct MeshoptView {
  std::span<const uint8_t> compressed;
  size_t count = 0, stride = 0;
  std::string mode, filter;
};

/// Decodes into count x stride bytes. Returns what is wrong, or an empty string.
std::string decode_meshopt(const MeshoptView& view, Bytes& decoded);

}  // namespace vernier
