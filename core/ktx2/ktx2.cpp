// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/ktx2.h"

#include <utility>

#include "core/ktx2/etc1s.h"
#include "core/ktx2/level.h"
#include "core/ktx2/little_endian.h"
#include "core/ktx2/uastc.h"

namespace vernier::ktx2 {
namespace {

/// Channels that are missing are 0, alpha 255, as Vulkan reads such texels.
void copy_plain(const Container& container, Texture& texture) {
  const size_t channels = container.plain_channels;
  const Level level(container, texture.rgba.size() / 4 * channels);
  const std::span<const uint8_t> bytes = level.bytes();
  for (size_t i = 0; i < texture.rgba.size(); ++i) {
    const size_t channel = i % 4;
    texture.rgba[i] = channel < channels ? bytes[i / 4 * channels + channel] : channel == 3 ? 255 : 0;
  }
}

void move_green(Texture& texture) {
  for (size_t i = 0; i < texture.rgba.size(); i += 4) {
    texture.rgba[i + 1] = texture.rgba[i + 3];
    texture.rgba[i + 2] = 0;
    texture.rgba[i + 3] = 255;
  }
}

}  // namespace

uint64_t stated_texels(std::span<const uint8_t> file) {
  constexpr size_t width_at = 20, height_at = 24;  // KTX File Format Specification 2.0, 3
  if (file.size() < height_at + sizeof(uint32_t)) return 0;
  return uint64_t{read_number<uint32_t>(file, width_at)} * read_number<uint32_t>(file, height_at);
}

Texture decode(std::span<const uint8_t> file, uint64_t max_texels) {
  Container container = parse_container(file, max_texels);
  Texture texture;
  texture.width = container.width;
  texture.height = container.height;
  texture.transfer = container.transfer;
  texture.remarks = std::move(container.remarks);
  texture.rgba.resize(size_t{texture.width} * texture.height * 4);
  texture.is_basis_universal = container.format != Format::plain;
  if (container.format == Format::etc1s) decode_etc1s(container, texture);
  if (container.format == Format::uastc) decode_uastc(container, texture);
  if (container.format == Format::plain) copy_plain(container, texture);
  if (container.has_green_in_alpha) move_green(texture);
  return texture;
}

}  // namespace vernier::ktx2
