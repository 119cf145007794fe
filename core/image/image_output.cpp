// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/base/atomic_file.h"
#include "core/image/image_io.h"
#include "vernier/error.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

Error output_error(const std::string& file, const std::string& problem) {
  return Error(ErrorKind::output, file, {}, problem);
}

/// Lets OpenImageIO write into an AtomicFile, so that no library sees its name and the system's reason for a
/// failure is kept.
class AtomicFileProxy : public OIIO::Filesystem::IOProxy {
 public:
  AtomicFileProxy(const std::string& name, AtomicFile& file) : IOProxy(name, Write), file_(file) {}

  const char* proxytype() const override { return "vernier"; }
  size_t write(const void* data, size_t size) override {
    const size_t written = pwrite(data, size, m_pos);
    m_pos += int64_t(written);
    return written;
  }
  size_t pwrite(const void* data, size_t size, int64_t offset) override {
    if (!file_.write_at({static_cast<const std::byte*>(data), size}, uint64_t(offset))) return 0;
    size_ = std::max(size_, size_t(offset) + size);
    return size;
  }
  size_t size() const override { return size_; }

 private:
  AtomicFile& file_;
  size_t size_ = 0;
};

void write_image(const std::string& path, const char* format, const OIIO::ImageSpec& spec, const void* pixels,
                 OIIO::Filesystem::IOProxy& proxy) {
  const auto output = OIIO::ImageOutput::create(format);
  if (!output)
    throw output_error(path, fmt::format("this OpenImageIO cannot write {}: {}", format, OIIO::geterror()));
  output->set_ioproxy(&proxy);
  if (!output->open(fmt::format("picture.{}", format), spec) || !output->write_image(spec.format, pixels) ||
      !output->close())
    throw output_error(path, fmt::format("cannot write image: {}", output->geterror()));
}

void set_metadata(OIIO::ImageSpec& spec, const Metadata& metadata, bool as_lines) {
  std::string lines;
  for (const auto& [name, value] : metadata) {
    spec.attribute(name, value);
    lines += fmt::format("{}: {}\n", name, value);
  }
  if (as_lines && !lines.empty()) spec.attribute("ImageDescription", lines);
}

// Encoded in memory first: on a full disk libpng's writer says nothing and libjpeg's ends the process.
std::vector<unsigned char> encode(const std::string& path, const char* format, const Image8& image,
                                  const Metadata& metadata) {
  if (image.empty()) throw output_error(path, "image has no pixels");
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  const bool jpeg = std::strcmp(format, "jpeg") == 0;
  if (jpeg) {
    spec.attribute("compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  set_metadata(spec, metadata, jpeg);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  write_image(path, format, spec, image.values.data(), memory);
  return bytes;
}

bool is_color_or_alpha(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "A";
}

/// The values with those limited that are to be stored in 16 bits.
Image limited(const Image& image, const std::vector<std::string>& channel_names) {
  Image result = image;
  for (size_t i = 0; i < result.values.size(); ++i)
    if (is_color_or_alpha(channel_names[i % channel_names.size()]) && !std::isnan(result.values[i]))
      result.values[i] = std::clamp(result.values[i], -largest_half, largest_half);
  return result;
}

OIIO::ImageSpec exr_spec(const std::string& path, const Image& image,
                         const std::vector<std::string>& channel_names, const Metadata& metadata,
                         const ExrOptions& options) {
  if (image.empty() || channel_names.size() != size_t(image.channels))
    throw output_error(path, fmt::format("image has {} channels and {} channel names", image.channels,
                                         channel_names.size()));
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeFloat);
  spec.channelnames = channel_names;
  spec.alpha_channel = spec.channelindex("A");
  if (const PicturePlace& place = options.place; place.full_width > 0) {
    spec.x = place.x;
    spec.y = place.y;
    spec.full_width = place.full_width;
    spec.full_height = place.full_height;
  }
  spec.attribute("compression", options.compression);
  if (options.half)
    for (const auto& name : channel_names)
      spec.channelformats.push_back(is_color_or_alpha(name) ? OIIO::TypeHalf : OIIO::TypeFloat);
  // Red, green, blue and white of Rec.709 (ITU-R BT.709-6, 1.3 and 1.4).
  const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
  // An empty date is left out; without it OpenImageIO writes the time of day, and no two files are alike.
  spec.attribute("DateTime", "");
  set_metadata(spec, metadata, false);
  return spec;
}

// OpenImageIO's name of the format that a path's extension asks for; null when it is none of ours.
const char* format_of(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".exr") return "openexr";
  if (extension == ".png") return "png";
  if (extension == ".jpg" || extension == ".jpeg") return "jpeg";
  return nullptr;
}

}  // namespace

void write_exr(const std::string& path, const Image& image, const std::vector<std::string>& channel_names,
               const Metadata& metadata, const ExrOptions& options) {
  const OIIO::ImageSpec spec = exr_spec(path, image, channel_names, metadata, options);
  const Image half = options.half ? limited(image, channel_names) : Image();
  AtomicFile file(path);
  AtomicFileProxy proxy(path, file);
  try {
    write_image(path, "openexr", spec, (options.half ? half : image).values.data(), proxy);
  } catch (const Error&) {
    if (!file.has_failed()) throw;  // else commit() knows more than the library does
  }
  file.commit();
}

std::vector<unsigned char> encode_exr(const Image& image, const std::vector<std::string>& channel_names,
                                      const Metadata& metadata, const ExrOptions& options) {
  const std::string name = "picture";
  const Image half = options.half ? limited(image, channel_names) : Image();
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  write_image(name, "openexr", exr_spec(name, image, channel_names, metadata, options),
              (options.half ? half : image).values.data(), memory);
  return bytes;
}

void write_image8(const std::string& path, const Image8& image, const Metadata& metadata) {
  const char* format = format_of(path);
  if (!format || std::strcmp(format, "openexr") == 0)
    throw output_error(path, "cannot write 8-bit values to this kind of file; use .png or .jpg");
  const std::vector<unsigned char> bytes = encode(path, format, image, metadata);
  const std::array parts{std::as_bytes(std::span(bytes))};
  write_file(path, parts);
}

std::vector<unsigned char> encode_image8(const std::string& format, const Image8& image,
                                         const Metadata& metadata) {
  return encode("picture", format == "jpg" ? "jpeg" : format.c_str(), image, metadata);
}

void check_image_name(const std::string& path) {
  if (!format_of(path))
    throw output_error(path, "cannot write this kind of image; end the name in .exr, .png or .jpg");
}

void check_writable_image(const std::string& path) {
  check_image_name(path);
  check_writable(path);
}

}  // namespace vernier
