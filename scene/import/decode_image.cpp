// SPDX-License-Identifier: Apache-2.0
#include "scene/import/decode_image.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/fingerprint.h"
#include "core/image/image_header.h"
#include "core/image/image_io.h"
#include "scene/import/data_uri.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// KTX2 without an alpha that means anything takes three channels, as other files do.
Image8 to_image(const ktx2::Texture& texture) {
  const std::vector<uint8_t>& rgba = texture.rgba;
  bool is_opaque = true;
  for (size_t i = 3; i < rgba.size(); i += 4) is_opaque = is_opaque && rgba[i] == 255;
  Image8 image(int(texture.width), int(texture.height), is_opaque ? 3 : 4);
  for (size_t i = 0, at = 0; i < rgba.size(); i += 4)
    for (size_t c = 0; c < size_t(image.channels); ++c) image.values[at++] = rgba[i + c];
  return image;
}

void decode_ktx2(std::span<const uint8_t> bytes, const std::string& name, DecodedImage& image) {
  try {
    ktx2::Texture texture = ktx2::decode(bytes);
    image.pixels = std::make_shared<const Image8>(to_image(texture));
    image.remarks.insert(image.remarks.end(), texture.remarks.begin(), texture.remarks.end());
    image.transfer = texture.transfer;
    if (!texture.is_basis_universal)
      image.basisu_problem = name +
                             ": KTX2: its texels are uncompressed (vkFormat is not 0), the extension allows "
                             "Basis Universal only";
  } catch (const Error& e) {
    image.problem = name + ": " + e.what();
  }
}

}  // namespace

uint64_t expected_bytes(const Document& document, int index) {
  const ImageSource& source = document.images()[size_t(index)];
  AssetContent content;
  std::span<const uint8_t> bytes;
  if (source.view >= 0) {
    bytes = document.view(source.view);
  } else {
    content = document.files().read_uri(source.uri, fmt::format("/images/{}/uri", index));
    bytes = content.bytes.span();
  }
  // What claims more is refused when it is decoded.
  constexpr uint64_t most_pixels = uint64_t(ImageLimits{}.max_pixels);
  if (ktx2::is_ktx2(bytes)) return 4 * std::min(ktx2::stated_texels(bytes), most_pixels);
  const auto header = parse_image_header(bytes);
  if (!header || header->width <= 0 || header->height <= 0) return 0;
  if (uint64_t(header->width) > most_pixels || uint64_t(header->height) > most_pixels) return 0;
  return std::min(uint64_t(header->width) * uint64_t(header->height), most_pixels) *
         uint64_t(header->bytes_per_pixel);
}

DecodedImage decode_image(const Document& document, int index) {
  const ImageSource& source = document.images()[size_t(index)];
  const std::string place = fmt::format("/images/{}", index);
  DecodedImage image;
  Bytes file;
  std::span<const uint8_t> bytes;
  if (source.view >= 0) {
    bytes = document.view(source.view);
  } else {
    AssetContent content = document.files().read_uri(source.uri, place + "/uri");
    if (!content.problem.empty()) {
      image.problem = content.problem;
      return image;
    }
    if (!content.remark.empty()) image.remarks.push_back(content.remark);
    file = std::move(content.bytes);
    bytes = file.span();
    if (!is_data_uri(source.uri)) image.fingerprint = fingerprint(bytes);
  }
  const bool is_file = source.view < 0 && !is_data_uri(source.uri);
  const std::string name =
      document.files().scene_path() + place + (is_file ? fmt::format(" ({})", source.uri) : "");
  if (ktx2::is_ktx2(bytes)) {
    decode_ktx2(bytes, name, image);
    return image;
  }
  try {
    PartialImage decoded = decode_partial_image(bytes, name);
    image.pixels = std::visit(
        []<typename T>(BasicImage<T>& pixels) {
          return TexturePixels(std::make_shared<const BasicImage<T>>(std::move(pixels)));
        },
        decoded.image);
    if (!decoded.damage.empty()) image.remarks.push_back(decoded.damage);
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::memory) throw;
    image.problem = e.what();
  }
  return image;
}

}  // namespace vernier
