// SPDX-License-Identifier: Apache-2.0
#include "core/image/png_repair.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "core/image/image_header.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using Bytes = std::span<const uint8_t>;

size_t word_at(Bytes bytes, size_t at) {
  return size_t(bytes[at]) << 24 | size_t(bytes[at + 1]) << 16 | size_t(bytes[at + 2]) << 8 | bytes[at + 3];
}

bool is_type(Bytes bytes, size_t at, const char* type) { return std::memcmp(&bytes[at], type, 4) == 0; }

/// What the image header (ISO/IEC 15948, 11.2.2) says of the uncompressed data.
struct Layout {
  size_t width, height, bits_a_pixel;
  bool interlaced;

  explicit Layout(Bytes header) : width(word_at(header, 0)), height(word_at(header, 4)) {
    const size_t channels[] = {1, 0, 3, 1, 2, 0, 4, 0};
    bits_a_pixel = header[8] * channels[header[9] & 7];
    interlaced = header[12] != 0;
  }

  /// Bytes of an image of this size: rows of whole bytes, each after its filter's number.
  size_t bytes_of(size_t columns, size_t rows) const {
    return columns == 0 ? 0 : rows * (1 + (columns * bits_a_pixel + 7) / 8);
  }
  size_t first_row() const { return bytes_of(interlaced ? (width + 7) / 8 : width, 1); }
  size_t all() const {
    if (!interlaced) return bytes_of(width, height);
    // Adam7: where the columns and rows of each pass begin and how far they are apart.
    constexpr size_t passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                     {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    size_t sum = 0;
    for (const auto& [x, y, step_x, step_y] : passes)
      sum += bytes_of((width + step_x - 1 - x) / step_x, (height + step_y - 1 - y) / step_y);
    return sum;
  }
};

/// Decompresses as much as there is, up to the size of `out`; returns how much that was.
size_t inflate_part(std::vector<uint8_t>& compressed, std::vector<uint8_t>& out) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw Error(ErrorKind::memory, "out of memory decompressing an image");
  size_t in = 0, done = 0;
  for (int status = Z_OK; status == Z_OK && done < out.size();) {
    // zlib counts in 32 bits.
    constexpr size_t most = size_t{1} << 30;
    stream.next_in = compressed.data() + in;
    stream.avail_in = uInt(std::min(most, compressed.size() - in));
    stream.next_out = out.data() + done;
    stream.avail_out = uInt(std::min(most, out.size() - done));
    status = inflate(&stream, Z_NO_FLUSH);
    in = size_t(stream.next_in - compressed.data());
    done = size_t(stream.next_out - out.data());
  }
  inflateEnd(&stream);
  return done;
}

void add_word(std::vector<uint8_t>& file, size_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) file.push_back(uint8_t(word >> shift));
}

void add_chunk(std::vector<uint8_t>& file, const char* type, Bytes data) {
  add_word(file, data.size());
  const size_t start = file.size();
  file.insert(file.end(), type, type + 4);
  file.insert(file.end(), data.begin(), data.end());
  add_word(file, png_checksum(Bytes(file).subspan(start)));
}

std::vector<uint8_t> compress_all(const std::vector<uint8_t>& data) {
  std::vector<uint8_t> compressed(compressBound(data.size()));
  uLongf size = compressed.size();
  if (compress2(compressed.data(), &size, data.data(), data.size(), Z_BEST_SPEED) != Z_OK)
    throw Error(ErrorKind::memory, "out of memory compressing an image");
  compressed.resize(size);
  return compressed;
}

}  // namespace

std::vector<uint8_t> complete_png(Bytes bytes, const std::string& name) {
  constexpr size_t header_start = 16, header_size = 13, first_chunk = 8;
  const auto fail = [&] {
    throw Error(ErrorKind::input, name, {},
                "png image is truncated before its first row; get a whole copy of the file");
  };
  if (bytes.size() < header_start + header_size) fail();
  const Layout layout(bytes.subspan(header_start, header_size));
  std::vector<uint8_t> whole(bytes.begin(), bytes.begin() + first_chunk), pixels;
  for (size_t at = first_chunk; at + 8 < bytes.size();) {
    const size_t length = word_at(bytes, at), there = std::min(length, bytes.size() - at - 8);
    const Bytes data = bytes.subspan(at + 8, there);
    if (is_type(bytes, at + 4, "IDAT"))
      pixels.insert(pixels.end(), data.begin(), data.end());
    else if (pixels.empty() && there == length && at + 12 + length <= bytes.size())
      add_chunk(whole, reinterpret_cast<const char*>(&bytes[at + 4]), data);
    at += 12 + length;
  }
  std::vector<uint8_t> rows(layout.all());
  if (layout.bits_a_pixel == 0 || inflate_part(pixels, rows) < layout.first_row()) fail();
  add_chunk(whole, "IDAT", compress_all(rows));
  add_chunk(whole, "IEND", {});
  return whole;
}

}  // namespace vernier
