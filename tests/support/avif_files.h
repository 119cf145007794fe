// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace vernier::test {

/// A file of tests/core/avif, by its name without ".avif"; make_fixtures.mjs there tells their texels.
inline std::vector<uint8_t> avif_fixture(const std::string& name) {
  std::ifstream file(std::string(VERNIER_SOURCE_DIR) + "/tests/core/avif/" + name + ".avif",
                     std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace vernier::test
