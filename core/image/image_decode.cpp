// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_decode.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <webp/decode.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/image/avif.h"
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

/// Codes as numbers in [0, 1].
Image to_floats(const CodedImage& coded) {
  return std::visit(
      []<typename T>(const BasicImage<T>& image) {
        Image converted(image.width, image.height, image.channels);
        std::transform(image.values.begin(), image.values.end(), converted.values.begin(),
                       [](T value) { return float(value) / float(std::numeric_limits<T>::max()); });
        return converted;
      },
      coded);
}

/// Many files of sixteen bits were made from eight: then that is what there is to keep.
CodedImage narrowed(Image16 image) {
  constexpr uint16_t step = 65535 / 255;
  const auto& values = image.values;
  if (std::any_of(values.begin(), values.end(), [](uint16_t value) { return value % step != 0; }))
    return image;
  Image8 narrow(image.width, image.height, image.channels);
  std::transform(values.begin(), values.end(), narrow.values.begin(),
                 [](uint16_t value) { return uint8_t(value / step); });
  return narrow;
}

/// A PNG or JPEG in memory, opened.
class MemoryInput {
 public:
  MemoryInput(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
              bool in_part)
      : name_(name),
        completed_(in_part && header.format == std::string_view("png") ? complete_png(bytes, name)
                                                                       : std::vector<uint8_t>()),
        memory_(completed_.empty() ? bytes.data() : completed_.data(),
                completed_.empty() ? bytes.size() : completed_.size()),
        input_(OIIO::ImageInput::create(header.format)) {
    if (!input_)
      throw input_error(
          name, fmt::format("this OpenImageIO cannot read {} images: {}", header.format, OIIO::geterror()));
    input_->set_ioproxy(&memory_);
    OIIO::ImageSpec spec, config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    // The name's extension must be the format's: some readers check it.
    if (!input_->open(fmt::format("memory.{}", header.format), spec, config))
      throw input_error(name, fmt::format("cannot decode {} image: {}", header.format, input_->geterror()));
  }

  bool has_sixteen_bits() const { return input_->spec().format == OIIO::TypeDesc::UINT16; }

  template <typename T>
  BasicImage<T> read() {
    const OIIO::ImageSpec spec = input_->spec();
    BasicImage<T> image(spec.width, spec.height, spec.nchannels);
    input_->threads(1);  // callers decode many images at once
    // To convert, read_image takes 64 MB beside the picture, however small it is.
    constexpr OIIO::TypeDesc type = OIIO::BaseTypeFromC<T>::value;
    const bool is_read =
        spec.format == type
            ? input_->read_native_scanlines(0, 0, spec.y, spec.y + spec.height, 0, image.values.data())
            : input_->read_image(0, 0, 0, spec.nchannels, type, image.values.data());
    if (!is_read)
      throw input_error(name_, fmt::format("cannot decode image, it is damaged: {}", input_->geterror()));
    return image;
  }

 private:
  const std::string& name_;
  std::vector<uint8_t> completed_;
  OIIO::Filesystem::IOMemReader memory_;
  OIIO::ImageInput::unique_ptr input_;
};

/// By the libraries that are called here without OpenImageIO; empty: it is none of theirs.
std::optional<CodedImage> decode_directly(std::span<const uint8_t> bytes, const ImageHeader& header,
                                          const std::string& name, bool in_part) {
  const std::string_view format = header.format;
  if (format == "webp") return decode_webp(bytes, name, in_part);
  if (format == "avif") return decode_avif(bytes, header, name);
  return std::nullopt;
}

CodedImage decode(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                  bool in_part) {
  CodedImage image = [&]() -> CodedImage {
    if (auto decoded = decode_directly(bytes, header, name, in_part)) return std::move(*decoded);
    MemoryInput input(bytes, header, name, in_part);
    if (input.has_sixteen_bits()) return narrowed(input.read<uint16_t>());
    return input.read<uint8_t>();
  }();
  const int channels = std::visit([](const auto& coded) { return coded.channels; }, image);
  if (channels > 4) throw input_error(name, fmt::format("image has {} channels; expected 1 to 4", channels));
  return image;
}

std::string description_of_damage(const ImageHeader& header, size_t size) {
  return fmt::format("{} image is truncated or damaged ({} bytes); get a whole copy of the file",
                     header.format, size);
}

void check_size(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                const ImageLimits& limits) {
  const bool has_size = header.width > 0 && header.height > 0;
  if (!has_size && !header.intact) throw input_error(name, description_of_damage(header, bytes.size()));
  check_image_size(name, header.width, header.height, 1, bytes.size(), limits, header.most_pixels_per_byte);
}

/// Throws unless the file is whole.
void check_whole(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                 const ImageLimits& limits) {
  check_size(bytes, header, name, limits);
  if (!header.intact) throw input_error(name, description_of_damage(header, bytes.size()));
}

ImageHeader parse_header(std::span<const uint8_t> bytes, const std::string& name) {
  const auto header = parse_image_header(bytes);
  if (!header)
    throw input_error(name, bytes.empty()
                                ? "image has no bytes"
                                : "not a PNG, JPEG, WebP or AVIF image; convert it to one of these");
  return *header;
}

}  // namespace

void check_image_size(const std::string& name, int64_t width, int64_t height, int channels,
                      uint64_t file_bytes, const ImageLimits& limits, int64_t most_values_per_byte) {
  constexpr int64_t always_fine = int64_t{1} << 24;
  constexpr int max_channels = 1024;
  if (width <= 0 || height <= 0)
    throw input_error(name, fmt::format("image of size {}x{} has no pixels", width, height));
  if (height > limits.max_pixels / width)
    throw input_error(name, fmt::format("image of {}x{} pixels is larger than the limit of {} pixels; {}",
                                        width, height, limits.max_pixels, limits.advice));
  if (channels < 1 || channels > max_channels)
    throw input_error(
        name, fmt::format("image with {} channels cannot be used; expected 1 to {}", channels, max_channels));
  if (width * height > always_fine && uint64_t(width * height * channels / most_values_per_byte) > file_bytes)
    throw input_error(
        name, fmt::format("image header claims {}x{} pixels but the file has only {} bytes; it is damaged "
                          "or hostile",
                          width, height, file_bytes));
}

Image decode_image(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                   const ImageLimits& limits) {
  check_whole(bytes, header, name, limits);
  return to_floats(decode(bytes, header, name, false));
}

PartialImage decode_partial_image(std::span<const uint8_t> bytes, const std::string& name,
                                  const ImageLimits& limits) {
  const ImageHeader header = parse_header(bytes, name);
  if (!header.cut_off || header.intact) return {decode_whole_image(bytes, name, limits), {}};
  check_size(bytes, header, name, limits);
  return {decode(bytes, header, name, true),
          description_of_damage(header, bytes.size()) + "; what it holds is used"};
}

CodedImage decode_whole_image(std::span<const uint8_t> bytes, const std::string& name,
                              const ImageLimits& limits) {
  const ImageHeader header = parse_header(bytes, name);
  check_whole(bytes, header, name, limits);
  return decode(bytes, header, name, false);
}

}  // namespace vernier
