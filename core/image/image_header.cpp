// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_header.h"

#include <algorithm>
#include <array>
#include <boost/crc.hpp>
#include <limits>
#include <string_view>

namespace vernier {
namespace {

using Bytes = std::span<const uint8_t>;

bool has_text(Bytes bytes, size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() && std::equal(text.begin(), text.end(), bytes.begin() + at,
                                                        [](char a, uint8_t b) { return uint8_t(a) == b; });
}

int64_t big_endian(Bytes bytes, size_t at, size_t count) {
  int64_t value = 0;
  for (size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
  return value;
}

int64_t little_endian(Bytes bytes, size_t at, size_t count) {
  int64_t value = 0;
  for (size_t i = count; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

/// A pixel's, of this bit depth and color type (ISO/IEC 15948, 11.2.2); palettes may have alpha.
int decoded_png_bytes(int depth, int color_type) {
  const int channels = color_type == 0 ? 1 : color_type == 4 ? 2 : color_type == 2 ? 3 : 4;
  return channels * (depth == 16 ? 2 : 1);
}

// PNG (ISO/IEC 15948): signature, then chunks of length, type, data, checksum; IHDR first, IEND last.
// Checksums are tested here because libpng writes its complaints to standard error.
ImageHeader parse_png(Bytes bytes) {
  ImageHeader header{"png"};
  if (bytes.size() >= 24 && has_text(bytes, 12, "IHDR")) {
    header.width = big_endian(bytes, 16, 4);
    header.height = big_endian(bytes, 20, 4);
  }
  if (bytes.size() >= 26) header.bytes_per_pixel = decoded_png_bytes(bytes[24], bytes[25]);
  size_t at = 8;
  for (header.cut_off = true; !header.intact && at + 12 <= bytes.size();) {
    const size_t length = size_t(big_endian(bytes, at, 4));
    if (length > bytes.size() - at - 12) break;
    header.cut_off = png_checksum(bytes.subspan(at + 4, length + 4)) == big_endian(bytes, at + 8 + length, 4);
    if (!header.cut_off) break;
    header.intact = has_text(bytes, at + 4, "IEND");
    at += 12 + length;
  }
  return header;
}

bool is_start_of_frame(uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

// JPEG (ITU-T T.81, annex B): marker segments with lengths; after a scan's header (SOS) entropy-coded data
// runs to the next marker that is neither a stuffed zero nor a restart. An embedded thumbnail lies inside a
// segment and is skipped.
ImageHeader parse_jpeg(Bytes bytes) {
  ImageHeader header{"jpeg"};
  header.bytes_per_pixel = 3;
  header.cut_off = true;
  size_t at = 2;
  while (at + 2 <= bytes.size()) {
    const uint8_t marker = bytes[at + 1];
    const bool in_scan = bytes[at] != 0xff || marker == 0 || (marker >= 0xd0 && marker <= 0xd7);
    if (in_scan || marker == 0xff) {
      ++at;
      continue;
    }
    if (marker == 0xd9) {
      header.intact = true;
      break;
    }
    if (at + 4 > bytes.size()) break;
    if (is_start_of_frame(marker) && at + 9 <= bytes.size()) {
      header.height = big_endian(bytes, at + 5, 2);
      header.width = big_endian(bytes, at + 7, 2);
    }
    at += 2 + size_t(std::max<int64_t>(2, big_endian(bytes, at + 2, 2)));
  }
  return header;
}

// WebP (RFC 9649): a RIFF container whose first chunk is VP8 (lossy), VP8L (lossless) or VP8X (extended).
ImageHeader parse_webp(Bytes bytes) {
  ImageHeader header{"webp"};
  header.intact = int64_t(bytes.size()) >= little_endian(bytes, 4, 4) + 8;
  header.cut_off = !header.intact;
  if (bytes.size() < 30) return header;
  if (has_text(bytes, 12, "VP8 ")) {
    header.width = little_endian(bytes, 26, 2) & 0x3fff;
    header.height = little_endian(bytes, 28, 2) & 0x3fff;
  } else if (has_text(bytes, 12, "VP8L")) {
    const int64_t packed = little_endian(bytes, 21, 4);
    header.width = (packed & 0x3fff) + 1;
    header.height = (packed >> 14 & 0x3fff) + 1;
  } else if (has_text(bytes, 12, "VP8X")) {
    header.width = little_endian(bytes, 24, 3) + 1;
    header.height = little_endian(bytes, 27, 3) + 1;
  }
  return header;
}

/// A box of the ISO base media file format (ISO/IEC 14496-12, 4.2).
struct Box {
  std::string_view type;
  Bytes content;
  size_t size = 0;  ///< with its head
};

/// The box at the beginning; empty when it does not lie within the bytes.
std::optional<Box> first_box(Bytes bytes) {
  if (bytes.size() < 8) return std::nullopt;
  auto size = uint64_t(big_endian(bytes, 0, 4));
  size_t head = 8;
  if (size == 0) size = bytes.size();  // to the end of the file
  if (size == 1) {
    if (bytes.size() < 16) return std::nullopt;
    size = uint64_t(big_endian(bytes, 8, 8));
    head = 16;
  }
  if (size < head || size > bytes.size()) return std::nullopt;
  return Box{{reinterpret_cast<const char*>(bytes.data()) + 4, 4},
             bytes.subspan(head, size_t(size) - head),
             size_t(size)};
}

/// Visits the boxes one after the other as far as they are whole; true: they fill the bytes.
template <typename Visit>
bool for_each_box(Bytes bytes, const Visit& visit) {
  while (!bytes.empty()) {
    const auto box = first_box(bytes);
    if (!box) return false;
    visit(*box);
    bytes = bytes.subspan(box->size);
  }
  return true;
}

/// The largest of the sizes (ispe) in the boxes meta, iprp and ipco, each in the one before: those of parts,
/// thumbnails and alpha are no larger than the picture's.
void find_avif_size(const Box& box, ImageHeader& header, size_t depth = 0) {
  constexpr std::array<std::string_view, 4> way{"meta", "iprp", "ipco", "ispe"};
  if (box.type != way[depth]) return;
  const size_t version = box.type == "meta" ? 4 : 0;
  if (box.type != "ispe") {
    if (box.content.size() >= version)
      for_each_box(box.content.subspan(version),
                   [&](const Box& inner) { find_avif_size(inner, header, depth + 1); });
    return;
  }
  if (box.content.size() < 12) return;
  const int64_t width = big_endian(box.content, 4, 4), height = big_endian(box.content, 8, 4);
  constexpr int64_t most = std::numeric_limits<int32_t>::max();
  if (width > most || height > most || width * height <= header.width * header.height) return;
  header.width = width;
  header.height = height;
}

// AVIF (AV1 Image File Format, 1.1): boxes, the first of which (ftyp) names the brand. A picture of one color
// of 8192 x 8192 pixels has 1,078 bytes.
ImageHeader parse_avif(Bytes bytes) {
  ImageHeader header{"avif"};
  header.most_pixels_per_byte = 1 << 17;
  header.bytes_per_pixel = 8;
  header.intact = for_each_box(bytes, [&](const Box& box) { find_avif_size(box, header); });
  return header;
}

bool is_avif(Bytes bytes) {
  if (bytes.size() < 16 || !has_text(bytes, 4, "ftyp")) return false;
  const size_t end = std::min<size_t>(bytes.size(), size_t(big_endian(bytes, 0, 4)));
  for (size_t brand = 8; brand + 4 <= end; brand += 4)
    if (has_text(bytes, brand, "avif")) return true;
  return false;
}

}  // namespace

uint32_t png_checksum(std::span<const uint8_t> type_and_data) {
  boost::crc_32_type checksum;
  checksum.process_bytes(type_and_data.data(), type_and_data.size());
  return checksum.checksum();
}

std::optional<ImageHeader> parse_image_header(std::span<const uint8_t> bytes) {
  if (has_text(bytes, 0, "\x89PNG\r\n\x1a\n")) return parse_png(bytes);
  if (has_text(bytes, 0, "\xff\xd8\xff")) return parse_jpeg(bytes);
  if (has_text(bytes, 0, "RIFF") && has_text(bytes, 8, "WEBP")) return parse_webp(bytes);
  if (is_avif(bytes)) return parse_avif(bytes);
  return std::nullopt;
}

}  // namespace vernier
