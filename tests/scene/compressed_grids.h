// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/scene/import_support.h"

// Meshes as the encoders of meshopt and Draco write them.

namespace vernier::test {

/// A grid of n x n quads over the unit square, bent.
struct Grid {
  std::vector<float> positions;
  std::vector<uint32_t> indices;

  explicit Grid(uint32_t n) {
    for (uint32_t y = 0; y <= n; ++y)
      for (uint32_t x = 0; x <= n; ++x) {
        const float u = float(x) / float(n), v = float(y) / float(n);
        positions.insert(positions.end(), {u, v, u * v});
      }
    for (uint32_t y = 0; y < n; ++y)
      for (uint32_t x = 0; x < n; ++x) {
        const uint32_t a = y * (n + 1) + x, b = a + n + 1;
        indices.insert(indices.end(), {a, a + 1, b, a + 1, b + 1, b});
      }
  }
};

/// What a view that is compressed by meshopt says of itself.
nlohmann::json meshopt_view(int buffer_view_bytes, size_t count, size_t stride, const char* mode,
                            const char* filter = "NONE");

/// The grid with positions and indices compressed, in buffer 0; buffer 1 is the fallback nobody has.
GltfFile meshopt_grid(const Grid& grid);

/// The grid through Draco's encoder, with positions of 16 bits.
GltfFile draco_grid(const Grid& grid);

}  // namespace vernier::test
