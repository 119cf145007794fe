// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace vernier::test {

using FileBytes = std::vector<uint8_t>;

/// A file of tests/core/ktx2, by its name without ".ktx2".
FileBytes ktx2_fixture(const std::string& name);

/// What Binomial's transcoder makes of a fixture.
struct Ktx2Expectation {
  std::string name;
  uint32_t width = 0, height = 0;
  uint32_t checksum = 0;  ///< CRC-32 of the RGBA texels
};
std::vector<Ktx2Expectation> ktx2_expectations();

/// A KTX2 file of one level in a Vulkan format, with a descriptor that names `transfer`.
FileBytes plain_ktx2(uint32_t width, uint32_t height, uint32_t vk_format, const FileBytes& level,
                     uint8_t transfer = 1);

/// Overwrites a number of the file, which it must lie inside.
template <typename T>
void put(FileBytes& file, size_t at, T value) {
  std::memcpy(file.data() + at, &value, sizeof(T));
}

/// Where fields of a KTX2 file lie whose descriptor begins at byte 104, as the fixtures' do.
namespace ktx2_field {
constexpr size_t vk_format = 12, width = 20, height = 24, depth = 28, layers = 32, faces = 36, levels = 40,
                 supercompression = 44, descriptor_offset = 48, descriptor_size = 52, metadata_offset = 56,
                 metadata_size = 60, global_offset = 64, global_size = 72, level_offset = 80, level_size = 88,
                 uncompressed_size = 96, model = 116, transfer = 118, flags = 119, channel = 135,
                 second_channel = 151;
}  // namespace ktx2_field

}  // namespace vernier::test
