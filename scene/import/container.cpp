// SPDX-License-Identifier: Apache-2.0
#include "scene/import/container.h"

#include <fmt/format.h>

#include <cstring>

#include "vernier/error.h"

namespace vernier {
namespace {

constexpr uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;

uint32_t little_endian_word(std::span<const uint8_t> bytes, size_t offset) {
  return uint32_t(bytes[offset]) | uint32_t(bytes[offset + 1]) << 8 | uint32_t(bytes[offset + 2]) << 16 |
         uint32_t(bytes[offset + 3]) << 24;
}

}  // namespace

Container split_container(std::span<const uint8_t> bytes, const std::string& file) {
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {bytes, {}, false};
  const auto fail = [&](const std::string& problem) { throw Error(ErrorKind::input, file, "GLB", problem); };
  if (bytes.size() < 20) fail("the file is truncated: it ends inside the header");
  if (const uint32_t version = little_endian_word(bytes, 4); version != 2)
    fail(fmt::format("container version {}, only version 2 is read; convert the file to glTF 2.0", version));
  const size_t length = little_endian_word(bytes, 8);
  if (length > bytes.size())
    fail(fmt::format("the file is truncated: its header says {} bytes, there are {}", length, bytes.size()));

  Container parts;
  parts.is_glb = true;
  for (size_t offset = 12, chunk = 0; offset + 8 <= length; ++chunk) {
    const size_t chunk_length = little_endian_word(bytes, offset);
    const uint32_t type = little_endian_word(bytes, offset + 4);
    if (chunk_length > length - offset - 8)
      fail(fmt::format("chunk {} of {} bytes runs past the end of the file", chunk, chunk_length));
    const auto content = bytes.subspan(offset + 8, chunk_length);
    if (chunk == 0 && type != json_chunk) fail("the first chunk is not JSON");
    if (chunk == 0) parts.json = content;
    if (chunk == 1 && type == binary_chunk) parts.binary = content;
    offset += 8 + chunk_length;
  }
  if (parts.json.empty()) fail("there is no JSON chunk");
  return parts;
}

}  // namespace vernier
