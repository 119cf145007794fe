// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <webp/decode.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "core/image/png_repair.h"
#include "vernier/error.h"

namespace vernier {
namespace {

Error input_error(const std::string& file, const std::string& problem) {
  return Error(ErrorKind::input, file, {}, problem);
}

// OpenImageIO 2.4 multiplies WebP's colours by alpha whatever it is asked, so libwebp is called here. The
// incremental decoder also gives the rows of a file that is cut off.
Image8 decode_webp(std::span<const uint8_t> bytes, const std::string& name, bool in_part) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    throw input_error(name, "cannot decode webp image, it is damaged");
  if (features.has_animation)
    throw input_error(name, "animated WebP cannot be used; expected a still picture");
  Image8 image(features.width, features.height, features.has_alpha ? 4 : 3);
  const std::unique_ptr<WebPIDecoder, decltype(&WebPIDelete)> decoder(
      WebPINewRGB(features.has_alpha ? MODE_RGBA : MODE_RGB, image.values.data(), image.values.size(),
                  image.width * image.channels),
      WebPIDelete);
  if (!decoder) throw Error(ErrorKind::memory, name, {}, "out of memory decoding a webp image");
  const VP8StatusCode status = WebPIUpdate(decoder.get(), bytes.data(), bytes.size());
  int rows = 0;
  if (in_part && status == VP8_STATUS_SUSPENDED)
    WebPIDecGetRGB(decoder.get(), &rows, nullptr, nullptr, nullptr);
  if (status != VP8_STATUS_OK && rows == 0)
    throw input_error(name, "cannot decode webp image, it is damaged");
  return image;
}

template <typename T>
BasicImage<T> convert(Image8 image) {
  if constexpr (std::is_same_v<T, uint8_t>) return image;
  BasicImage<T> converted(image.width, image.height, image.channels);
  std::transform(image.values.begin(), image.values.end(), converted.values.begin(),
                 [](uint8_t value) { return T(value) / 255; });
  return converted;
}

template <typename T>
BasicImage<T> read_all_channels(OIIO::ImageInput& input, const std::string& name) {
  const OIIO::ImageSpec spec = input.spec();
  BasicImage<T> image(spec.width, spec.height, spec.nchannels);
  input.threads(1);  // callers decode many images at once
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::BaseTypeFromC<T>::value, image.values.data()))
    throw input_error(name, fmt::format("cannot decode image, it is damaged: {}", input.geterror()));
  return image;
}

template <typename T>
BasicImage<T> decode(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                     bool in_part) {
  if (header.format == std::string_view("webp")) return convert<T>(decode_webp(bytes, name, in_part));
  std::vector<uint8_t> completed;
  if (in_part && header.format == std::string_view("png")) bytes = completed = complete_png(bytes, name);
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::create(header.format);
  if (!input)
    throw input_error(
        name, fmt::format("this OpenImageIO cannot read {} images: {}", header.format, OIIO::geterror()));
  input->set_ioproxy(&memory);
  OIIO::ImageSpec spec, config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  // The name's extension must be the format's: some readers check it.
  if (!input->open(fmt::format("memory.{}", header.format), spec, config))
    throw input_error(name, fmt::format("cannot decode {} image: {}", header.format, input->geterror()));
  return read_all_channels<T>(*input, name);
}

std::string description_of_damage(const ImageHeader& header, size_t size) {
  return fmt::format("{} image is truncated or damaged ({} bytes); get a whole copy of the file",
                     header.format, size);
}

/// Of a file that is whole.
template <typename T>
BasicImage<T> decode_whole(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                           const ImageLimits& limits) {
  check_image_size(name, header.width, header.height, 1, bytes.size(), limits);
  if (!header.intact) throw input_error(name, description_of_damage(header, bytes.size()));
  return decode<T>(bytes, header, name, false);
}

ImageHeader parse_header(std::span<const uint8_t> bytes, const std::string& name) {
  const auto header = parse_image_header(bytes);
  if (!header)
    throw input_error(name, bytes.empty() ? "image has no bytes"
                                          : "not a PNG, JPEG or WebP image; convert it to one of these");
  return *header;
}

Image8 checked(Image8 image, const std::string& name) {
  if (image.channels > 4)
    throw input_error(name, fmt::format("image has {} channels; expected 1 to 4", image.channels));
  return image;
}

}  // namespace

void check_image_size(const std::string& name, int64_t width, int64_t height, int channels,
                      uint64_t file_bytes, const ImageLimits& limits) {
  constexpr int64_t always_fine = int64_t{1} << 24;
  // No format here packs more than some 1,500 values a byte: deflate 1,032, JPEG a bit per block.
  constexpr int64_t max_values_per_byte = 4096;
  constexpr int max_channels = 1024;
  if (width <= 0 || height <= 0)
    throw input_error(name, fmt::format("image of size {}x{} has no pixels", width, height));
  if (height > limits.max_pixels / width)
    throw input_error(
        name, fmt::format("image of {}x{} pixels is larger than the limit of {} pixels; scale it down", width,
                          height, limits.max_pixels));
  if (channels < 1 || channels > max_channels)
    throw input_error(
        name, fmt::format("image with {} channels cannot be used; expected 1 to {}", channels, max_channels));
  if (width * height > always_fine && uint64_t(width * height * channels / max_values_per_byte) > file_bytes)
    throw input_error(
        name, fmt::format("image header claims {}x{} pixels but the file has only {} bytes; it is damaged "
                          "or hostile",
                          width, height, file_bytes));
}

Image decode_image(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                   const ImageLimits& limits) {
  return decode_whole<float>(bytes, header, name, limits);
}

PartialImage8 decode_partial_image8(std::span<const uint8_t> bytes, const std::string& name,
                                    const ImageLimits& limits) {
  const ImageHeader header = parse_header(bytes, name);
  if (!header.cut_off || header.intact)
    return {checked(decode_whole<uint8_t>(bytes, header, name, limits), name), {}};
  check_image_size(name, header.width, header.height, 1, bytes.size(), limits);
  return {checked(decode<uint8_t>(bytes, header, name, true), name),
          description_of_damage(header, bytes.size()) + "; what it holds is used"};
}

Image8 decode_image8(std::span<const uint8_t> bytes, const std::string& name, const ImageLimits& limits) {
  return checked(decode_whole<uint8_t>(bytes, parse_header(bytes, name), name, limits), name);
}

}  // namespace vernier
