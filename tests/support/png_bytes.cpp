// SPDX-License-Identifier: Apache-2.0
#include "tests/support/png_bytes.h"

#include <algorithm>
#include <string_view>

namespace vernier::test {
namespace {

using Bytes = std::vector<uint8_t>;

void put_big_endian(Bytes& out, uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(uint8_t(value >> shift));
}

uint32_t crc32(const uint8_t* begin, const uint8_t* end) {
  uint32_t crc = ~0u;
  for (; begin != end; ++begin) {
    crc ^= *begin;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

void put_chunk(Bytes& out, std::string_view type, const Bytes& data) {
  put_big_endian(out, uint32_t(data.size()));
  const size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_big_endian(out, crc32(out.data() + start, out.data() + out.size()));
}

// A zlib stream (RFC 1950) of stored blocks.
Bytes zlib_stored(const Bytes& data) {
  Bytes out{0x78, 0x01};
  size_t at = 0;
  do {
    const size_t size = std::min<size_t>(65535, data.size() - at);
    const bool last = at + size == data.size();
    for (const size_t byte : {size_t(last), size & 255, size >> 8, ~size & 255, ~size >> 8 & 255})
      out.push_back(uint8_t(byte));
    out.insert(out.end(), data.begin() + at, data.begin() + at + size);
    at += size;
  } while (at < data.size());
  uint32_t a = 1, b = 0;
  for (const uint8_t byte : data) {
    a = (a + byte) % 65521;
    b = (b + a) % 65521;
  }
  put_big_endian(out, b << 16 | a);
  return out;
}

Bytes signature_and_header(uint32_t width, uint32_t height, int bit_depth, int colour_type) {
  Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes header;
  put_big_endian(header, width);
  put_big_endian(header, height);
  for (const int byte : {bit_depth, colour_type, 0, 0, 0}) header.push_back(uint8_t(byte));
  put_chunk(out, "IHDR", header);
  return out;
}

}  // namespace

Bytes png_bytes(const PngSource& source) {
  Bytes out = signature_and_header(source.width, source.height, source.bit_depth, source.colour_type);
  if (!source.palette.empty()) put_chunk(out, "PLTE", source.palette);
  if (!source.palette_alpha.empty()) put_chunk(out, "tRNS", source.palette_alpha);
  const size_t row = source.samples.size() / source.height;
  Bytes rows;
  for (size_t y = 0; y < source.height; ++y) {
    rows.push_back(0);
    rows.insert(rows.end(), source.samples.begin() + y * row, source.samples.begin() + (y + 1) * row);
  }
  put_chunk(out, "IDAT", zlib_stored(rows));
  put_chunk(out, "IEND", {});
  return out;
}

Bytes png_bomb(uint32_t width, uint32_t height) {
  Bytes out = signature_and_header(width, height, 8, 6);
  put_chunk(out, "IDAT", zlib_stored(Bytes(16)));
  put_chunk(out, "IEND", {});
  return out;
}

}  // namespace vernier::test
