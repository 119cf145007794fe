// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/container.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/ktx2/little_endian.h"
#include "vernier/error.h"

namespace vernier::ktx2 {
namespace {

using Bytes = std::span<const uint8_t>;
using std::to_string;

constexpr size_t level_index_offset = 80;
constexpr size_t level_index_stride = 24;
constexpr std::array<uint8_t, 12> signature{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};

Error input_error(const std::string& problem) { return Error(ErrorKind::input, "KTX2: " + problem); }

/// The stretch of a file that its header points to. Throws Error(input) when it does not lie inside.
Bytes part(Bytes file, uint64_t offset, uint64_t length, const char* name) {
  if (offset > file.size() || length > file.size() - offset)
    throw input_error(std::string(name) + " lies at " + to_string(offset) + " with " + to_string(length) +
                      " bytes, beyond the file's " + to_string(file.size()) +
                      "; the file is cut off or damaged");
  return file.subspan(size_t(offset), size_t(length));
}

/// Vulkan's formats by ranges, as far as files hold them.
std::string format_name(uint32_t format) {
  struct Range {
    uint32_t first, last;
    const char* name;
  };
  constexpr std::array<Range, 15> ranges{{{1, 130, "uncompressed"},
                                          {131, 134, "BC1"},
                                          {135, 136, "BC2"},
                                          {137, 138, "BC3"},
                                          {139, 140, "BC4"},
                                          {141, 142, "BC5"},
                                          {143, 144, "BC6H"},
                                          {145, 146, "BC7"},
                                          {147, 152, "ETC2"},
                                          {153, 156, "EAC"},
                                          {157, 184, "ASTC"},
                                          {1000054000, 1000054007, "PVRTC"},
                                          {1000066000, 1000066013, "ASTC HDR"},
                                          {1000288000, 1000288029, "ASTC 3D"},
                                          {1000340000, 1000340001, "uncompressed"}}};
  for (const Range& range : ranges)
    if (format >= range.first && format <= range.last) return range.name;
  return "an unknown format";
}

constexpr const char* remedy = "; convert it to ETC1S or UASTC, such as by 'ktx create --encode'";

/// Channels of a Vulkan format of eight bits each, red first; 0: another format.
uint32_t channels_of_plain(uint32_t format) {
  switch (format) {
    case 9:   // VK_FORMAT_R8_UNORM
    case 15:  // VK_FORMAT_R8_SRGB
      return 1;
    case 16:  // VK_FORMAT_R8G8_UNORM
    case 22:  // VK_FORMAT_R8G8_SRGB
      return 2;
    case 23:  // VK_FORMAT_R8G8B8_UNORM
    case 29:  // VK_FORMAT_R8G8B8_SRGB
      return 3;
    case 37:  // VK_FORMAT_R8G8B8A8_UNORM
    case 43:  // VK_FORMAT_R8G8B8A8_SRGB
      return 4;
    default:
      return 0;
  }
}

/// One 2D picture, of no more texels than the file can hold.
void check_shape(Bytes file, uint64_t max_texels) {
  const auto field = [&](size_t at) { return uint64_t{read_number<uint32_t>(file, at)}; };
  const uint64_t width = field(20), height = field(24), depth = field(28);
  const uint64_t layers = field(32), faces = field(36);
  if (faces != 1)
    throw input_error("a texture of " + to_string(faces) +
                      " faces (a cube map has 6); a 2D picture is expected");
  if (depth != 0)
    throw input_error("a depth of " + to_string(depth) + " makes it 3D; a 2D picture is expected");
  if (layers > 1)
    throw input_error("an array of " + to_string(layers) + " layers; a single picture is expected");
  if (width == 0 || height == 0)
    throw input_error("a size of " + to_string(width) + "x" + to_string(height) + " has no texels");
  if (height > max_texels / width)
    throw input_error("a size of " + to_string(width) + "x" + to_string(height) + " is beyond the limit of " +
                      to_string(max_texels) + " texels; scale it down");
  constexpr uint64_t always_fine = uint64_t{1} << 24;
  constexpr uint64_t most_a_byte = 4096;  // runs of equal blocks have no limit of their own
  if (width * height > always_fine && width * height / most_a_byte > file.size())
    throw input_error("a size of " + to_string(width) + "x" + to_string(height) + " in " +
                      to_string(file.size()) + " bytes; it is damaged or hostile");
}

/// What the first block of a data format descriptor says (Khronos Data Format 1.3, chapter 5).
struct Descriptor {
  uint8_t model, transfer, flags;
  std::vector<uint8_t> channels;  ///< by sample
};

Descriptor parse_descriptor(Bytes bytes) {
  constexpr size_t block_offset = 4, samples_offset = 28, sample_size = 16;
  if (bytes.size() < samples_offset)
    throw input_error("the data format descriptor has " + to_string(bytes.size()) +
                      " bytes, 44 at least are expected");
  const size_t block_size = read_number<uint16_t>(bytes, block_offset + 6);
  if (read_number<uint32_t>(bytes, block_offset) != 0 || block_size + block_offset > bytes.size())
    throw input_error("the data format descriptor is damaged");
  Descriptor descriptor{bytes[12], bytes[14], bytes[15], {}};
  for (size_t at = samples_offset; at + sample_size <= block_offset + block_size; at += sample_size)
    descriptor.channels.push_back(bytes[at + 3] & 0xf);
  return descriptor;
}

enum Supercompression : uint32_t { none = 0, basis_lz = 1, zstandard = 2 };

/// Of texels that are not compressed. Throws Error(input) for what glTF has no use for.
void set_plain_format(uint32_t format, uint32_t supercompression, Container& container) {
  container.format = Format::plain;
  container.plain_channels = channels_of_plain(format);
  if (container.plain_channels == 0)
    throw input_error("the vkFormat is " + to_string(format) + " (" + format_name(format) +
                      "); 0 (Basis Universal) is expected" + remedy);
  if (supercompression != none && supercompression != zstandard)
    throw input_error("the supercompression scheme is " + to_string(supercompression) +
                      "; 0 (none) or 2 (Zstandard) is expected");
}

/// Throws Error(input) for channels that no Basis Universal texture has.
void set_basis_format(const Descriptor& descriptor, uint32_t supercompression, Container& container) {
  constexpr uint8_t model_etc1s = 163, model_uastc = 166;
  if (descriptor.model != model_etc1s && descriptor.model != model_uastc)
    throw input_error("the color model is " + to_string(descriptor.model) +
                      "; ETC1S (163) or UASTC (166) is expected" + remedy);
  const bool is_etc1s = descriptor.model == model_etc1s;
  if (is_etc1s ? supercompression != basis_lz : supercompression != none && supercompression != zstandard)
    throw input_error("the supercompression scheme is " + to_string(supercompression) +
                      (is_etc1s ? "; for ETC1S 1 (BasisLZ) is expected"
                                : "; for UASTC 0 (none) or 2 (Zstandard) is expected"));
  using Channels = std::vector<uint8_t>;
  const Channels rgb{0}, rrr{3}, rgb_alpha{0, 15}, red_green{3, 4};  // ETC1S
  const Channels uastc_rgb{0}, uastc_rgba{3}, uastc_rrr{4}, uastc_rrrg{5}, uastc_rg{6};
  const auto is_one_of = [&](std::initializer_list<Channels> known) {
    return std::find(known.begin(), known.end(), descriptor.channels) != known.end();
  };
  if (is_etc1s ? !is_one_of({rgb, rrr, rgb_alpha, red_green})
               : !is_one_of({uastc_rgb, uastc_rgba, uastc_rrr, uastc_rrrg, uastc_rg}))
    throw input_error(
        "the data format descriptor names channels that glTF does not allow; RGB, RGBA, red, or "
        "red and green are expected");
  container.format = is_etc1s ? Format::etc1s : Format::uastc;
  container.has_second_slice = is_etc1s && descriptor.channels.size() == 2;
  if (descriptor.channels == (is_etc1s ? red_green : uastc_rrrg)) container.has_green_in_alpha = true;
}

TransferFunction transfer_function(uint8_t number) {
  return number == 1   ? TransferFunction::linear
         : number == 2 ? TransferFunction::srgb
                       : TransferFunction::other;
}

/// What glTF forbids and no reader of it does. Metadata that breaks off has nothing more to say.
void add_remarks(uint8_t flags, Bytes metadata, std::vector<std::string>& remarks) {
  constexpr uint8_t premultiplied = 1;
  if (flags & premultiplied)
    remarks.emplace_back(
        "its color is said to be multiplied by alpha, which glTF forbids; it is used as it is");
  while (metadata.size() >= 4) {
    const size_t length = read_number<uint32_t>(metadata, 0);
    if (length > metadata.size() - 4) return;
    const std::string_view entry(reinterpret_cast<const char*>(metadata.data()) + 4, length);
    const std::string_view key = entry.substr(0, entry.find('\0'));
    std::string_view value = entry.substr(std::min(key.size() + 1, entry.size()));
    value = value.substr(0, value.find('\0'));
    for (const auto& [name, allowed] : {std::pair{"KTXorientation", "rd"}, std::pair{"KTXswizzle", "rgba"}})
      if (key == name && value != allowed)
        remarks.emplace_back("its " + std::string(key) + " is '" + std::string(value.substr(0, 16)) +
                             "', glTF allows '" + allowed + "' only and it is read as that");
    metadata = metadata.subspan(std::min(metadata.size(), 4 + (length + 3) / 4 * 4));
  }
}

}  // namespace

bool is_ktx2(Bytes file) {
  return file.size() >= signature.size() && std::equal(signature.begin(), signature.end(), file.begin());
}

Container parse_container(Bytes file, uint64_t max_texels) {
  if (!is_ktx2(file)) throw input_error("the file does not begin with KTX2's signature");
  const uint32_t levels =
      file.size() < level_index_offset ? 0 : std::max(1u, read_number<uint32_t>(file, 40));
  if (levels == 0 || levels > (file.size() - level_index_offset) / level_index_stride)
    throw input_error("the header is cut off or damaged (" + to_string(file.size()) + " bytes)");
  check_shape(file, max_texels);

  const auto offset = [&](size_t at) { return uint64_t{read_number<uint32_t>(file, at)}; };
  Container container;
  container.width = read_number<uint32_t>(file, 20);
  container.height = read_number<uint32_t>(file, 24);
  container.image_count = levels;
  const Descriptor descriptor =
      parse_descriptor(part(file, offset(48), offset(52), "the data format descriptor"));
  const uint32_t vk_format = read_number<uint32_t>(file, 12);
  const uint32_t supercompression = read_number<uint32_t>(file, 44);
  if (vk_format == 0)
    set_basis_format(descriptor, supercompression, container);
  else
    set_plain_format(vk_format, supercompression, container);
  container.is_zstandard = supercompression == zstandard;
  container.transfer = transfer_function(descriptor.transfer);
  add_remarks(descriptor.flags, part(file, offset(56), offset(60), "the metadata"), container.remarks);
  container.global_data = part(file, read_number<uint64_t>(file, 64), read_number<uint64_t>(file, 72),
                               "the supercompression's global data");
  const auto level_field = [&](size_t at) { return read_number<uint64_t>(file, level_index_offset + at); };
  container.level = part(file, level_field(0), level_field(8), "the base level");
  container.uncompressed_size = level_field(16);
  return container;
}

}  // namespace vernier::ktx2
