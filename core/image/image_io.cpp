#include "core/image/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <webp/decode.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/image/image_header.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

constexpr int max_channels = 1024;

Error input_error(const std::string& file, const std::string& problem) {
  return Error(ErrorKind::input, file, {}, problem);
}

// Refuses a size that is empty, above the caps, or out of all proportion to the file: no format here packs
// more than some 1,500 values a byte (deflate 1,032; JPEG a bit per block), so a large picture in a tiny file
// is hostile.
void check_size(const std::string& name, int64_t width, int64_t height, int channels, uint64_t file_bytes,
                const ImageLimits& limits) {
  constexpr int64_t always_fine = int64_t{1} << 24;
  constexpr int64_t max_values_per_byte = 4096;
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

// One line, without OpenImageIO's trailing newlines.
std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == '.')) text.pop_back();
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text.empty() ? "unknown error" : text;
}

OIIO::ImageSpec read_config() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  return config;
}

// OpenImageIO 2.4 multiplies WebP's colours by alpha whatever it is asked, so libwebp is called here.
Image8 decode_webp(std::span<const uint8_t> bytes, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    throw input_error(name, "cannot decode webp image, it is damaged");
  if (features.has_animation)
    throw input_error(name, "animated WebP cannot be used; expected a still picture");
  Image8 image(features.width, features.height, features.has_alpha ? 4 : 3);
  const auto decode = features.has_alpha ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!decode(bytes.data(), bytes.size(), image.values.data(), image.values.size(),
              image.width * image.channels))
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
    throw input_error(name, "cannot decode image, it is damaged: " + one_line(input.geterror()));
  return image;
}

// A whole PNG, JPEG or WebP, all its channels.
template <typename T>
BasicImage<T> decode(std::span<const uint8_t> bytes, const ImageHeader& header, const std::string& name,
                     const ImageLimits& limits) {
  check_size(name, header.width, header.height, 1, bytes.size(), limits);
  if (!header.intact)
    throw input_error(name,
                      fmt::format("{} image is truncated or damaged ({} bytes); get a whole copy of the file",
                                  header.format, bytes.size()));
  if (header.format == std::string_view("webp")) return convert<T>(decode_webp(bytes, name));
  OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
  const auto input = OIIO::ImageInput::create(header.format);
  if (!input)
    throw input_error(name, fmt::format("this OpenImageIO cannot read {} images: {}", header.format,
                                        one_line(OIIO::geterror())));
  input->set_ioproxy(&memory);
  OIIO::ImageSpec spec;
  // The name's extension must be the format's: some readers check it.
  if (!input->open(fmt::format("memory.{}", header.format), spec, read_config()))
    throw input_error(name,
                      fmt::format("cannot decode {} image: {}", header.format, one_line(input->geterror())));
  return read_all_channels<T>(*input, name);
}

OIIO::ImageInput::unique_ptr open_file(const std::string& path, const ImageLimits& limits) {
  const OIIO::ImageSpec config = read_config();
  auto input = OIIO::ImageInput::open(path, &config);
  if (!input) throw input_error(path, "cannot read as an image: " + one_line(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.depth > 1 || spec.deep)
    throw input_error(path, "volume and deep images cannot be used; expected a flat one");
  check_size(path, spec.width, spec.height, spec.nchannels, fs::file_size(path), limits);
  check_size(path, spec.full_width, spec.full_height, spec.nchannels, fs::file_size(path), limits);
  return input;
}

std::vector<uint8_t> read_bytes(const std::string& path, size_t at_most = SIZE_MAX) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw input_error(path, "is a folder; expected an image file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw input_error(path, fmt::format("cannot open image: {}", std::strerror(errno)));
  std::vector<uint8_t> bytes(std::min<uint64_t>(at_most, fs::file_size(path, ignored)));
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  bytes.resize(size_t(stream.gcount()));
  return bytes;
}

using RgbChannels = std::array<int, 3>;

RgbChannels first_channels(int channels) {
  return channels >= 3 ? RgbChannels{0, 1, 2} : RgbChannels{0, 0, 0};
}

// Indices of red, green and blue: by name where the file has them, else the first three, else grey three
// times.
RgbChannels rgb_channels(const OIIO::ImageSpec& spec) {
  const RgbChannels named{spec.channelindex("R"), spec.channelindex("G"), spec.channelindex("B")};
  return named[0] >= 0 && named[1] >= 0 && named[2] >= 0 ? named : first_channels(spec.nchannels);
}

// Where the stored pixels lie in the picture. OpenEXR's data window may cover only part of the picture, or
// more than it; other formats' offsets are page positions and mean nothing here.
struct Placement {
  int width, height, left, top;
};

Placement placement(const OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  if (std::strcmp(input.format_name(), "openexr") != 0) return {spec.width, spec.height, 0, 0};
  return {spec.full_width, spec.full_height, spec.x - spec.full_x, spec.y - spec.full_y};
}

Image place(const Image& stored, const Placement& where, const RgbChannels& channels) {
  Image picture(where.width, where.height, 3);
  for (int y = std::max(0, where.top); y < std::min(where.height, where.top + stored.height); ++y)
    for (int x = std::max(0, where.left); x < std::min(where.width, where.left + stored.width); ++x)
      for (int c = 0; c < 3; ++c)
        picture.pixel(x, y)[c] = stored.pixel(x - where.left, y - where.top)[channels[c]];
  return picture;
}

}  // namespace

Image read_image(const std::string& path, const ImageLimits& limits) {
  std::vector<uint8_t> bytes = read_bytes(path, 32);
  if (parse_image_header(bytes)) {
    bytes = read_bytes(path);
    const Image stored = decode<float>(bytes, *parse_image_header(bytes), path, limits);
    return place(stored, {stored.width, stored.height, 0, 0}, first_channels(stored.channels));
  }
  const auto input = open_file(path, limits);
  const Image stored = read_all_channels<float>(*input, path);
  return place(stored, placement(*input), rgb_channels(input->spec()));
}

Image8 decode_image8(std::span<const uint8_t> bytes, const std::string& name, const ImageLimits& limits) {
  const auto header = parse_image_header(bytes);
  if (!header)
    throw input_error(name, bytes.empty() ? "image has no bytes"
                                          : "not a PNG, JPEG or WebP image; convert it to one of these");
  Image8 image = decode<uint8_t>(bytes, *header, name, limits);
  if (image.channels > 4)
    throw input_error(name, fmt::format("image has {} channels; expected 1 to 4", image.channels));
  return image;
}

}  // namespace vernier
