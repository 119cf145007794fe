// SPDX-License-Identifier: Apache-2.0
#include "tests/support/ktx2_files.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace vernier::test {
namespace {

const std::string folder = std::string(VERNIER_SOURCE_DIR) + "/tests/core/ktx2/";

}  // namespace

FileBytes ktx2_fixture(const std::string& name) {
  std::ifstream file(folder + name + ".ktx2", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<Ktx2Expectation> ktx2_expectations() {
  std::ifstream file(folder + "expected.txt");
  std::vector<Ktx2Expectation> all;
  Ktx2Expectation one;
  while (file >> one.name >> std::dec >> one.width >> one.height >> std::hex >> one.checksum)
    all.push_back(one);
  return all;
}

FileBytes plain_ktx2(uint32_t width, uint32_t height, uint32_t vk_format, const FileBytes& level,
                     uint8_t transfer) {
  constexpr size_t descriptor_size = 44, level_offset = 104 + descriptor_size;
  FileBytes file(level_offset + level.size());
  std::copy(level.begin(), level.end(), file.begin() + level_offset);
  const uint8_t signature[] = {0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
  std::memcpy(file.data(), signature, sizeof(signature));
  put(file, ktx2_field::vk_format, vk_format);
  put(file, ktx2_field::width, width);
  put(file, ktx2_field::height, height);
  put(file, ktx2_field::faces, uint32_t{1});
  put(file, ktx2_field::levels, uint32_t{1});
  put(file, ktx2_field::descriptor_offset, uint32_t{104});
  put(file, ktx2_field::descriptor_size, uint32_t{descriptor_size});
  put(file, ktx2_field::level_offset, uint64_t{level_offset});
  put(file, ktx2_field::level_size, uint64_t{level.size()});
  put(file, ktx2_field::uncompressed_size, uint64_t{level.size()});
  put(file, 104, uint32_t{descriptor_size});
  put(file, 112, uint16_t{2});
  put(file, 114, uint16_t{descriptor_size - 4});
  file[ktx2_field::model] = 1;
  file[ktx2_field::transfer] = transfer;
  return file;
}

}  // namespace vernier::test
