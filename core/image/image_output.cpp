// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

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

bool is_color_or_alpha(const std::string& channel) {
  return channel == "R" || channel == "G" || channel == "B" || channel == "A";
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

/// One part of an OpenEXR file, by the numbers of its channels in the picture.
struct Part {
  std::string name;
  std::vector<int> channels;
};

/// Blender (3.4) takes no channel without a dot but R, G, B, A and Z. It reads a part that has nothing else
/// as a failure, and leaves black what follows.
bool is_left_by_blender(const Part& part, const std::vector<std::string>& channel_names) {
  return std::none_of(part.channels.begin(), part.channels.end(), [&](int c) {
    const std::string& channel = channel_names[size_t(c)];
    return is_color_or_alpha(channel) || channel == "Z" || channel.find('.') != std::string::npos;
  });
}

std::vector<Part> parts_of(const std::vector<std::string>& channel_names) {
  std::vector<Part> parts;
  for (size_t c = 0; c < channel_names.size(); ++c) {
    const std::string& channel = channel_names[c];
    const std::string name = is_color_or_alpha(channel) ? "rgba" : channel.substr(0, channel.rfind('.'));
    const auto found =
        std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
    if (found != parts.end())
      found->channels.push_back(int(c));
    else
      parts.push_back({name, {int(c)}});
  }
  std::stable_partition(parts.begin(), parts.end(),
                        [&](const Part& part) { return !is_left_by_blender(part, channel_names); });
  return parts;
}

/// The first part says all of the picture; mattes are also described where they are, for programs that look
/// for them there (Cryptomatte 1.2: "cryptomatte/ID/name" is what their channels begin with).
Metadata metadata_of(const Part& part, bool is_first, const Metadata& all) {
  if (is_first) return all;
  Metadata of_part;
  for (const auto& [key, name] : all) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || !part.name.starts_with(name)) continue;
    const std::string prefix = key.substr(0, key.size() - std::string("name").size());
    for (const auto& [other, value] : all)
      if (other.starts_with(prefix)) of_part[other] = value;
  }
  return of_part;
}

Image channels_of(const Image& image, const std::vector<int>& channels) {
  Image chosen(image.width, image.height, int(channels.size()));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < channels.size(); ++c) chosen.pixel(x, y)[c] = image.pixel(x, y)[channels[c]];
  return chosen;
}

/// A file without a name in any folder: OpenImageIO 2.4 takes no proxy for files of several parts.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("vernier", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// By which this process can open it; empty where there is none.
  std::string name() const {
    return descriptor_ < 0 ? std::string() : fmt::format("/proc/self/fd/{}", descriptor_);
  }
  void copy_to(OIIO::Filesystem::IOProxy& proxy) const {
    std::vector<char> block(size_t(1) << 16);
    for (off_t offset = 0;;) {
      const ssize_t count = ::pread(descriptor_, block.data(), block.size(), offset);
      if (count <= 0 || proxy.write(block.data(), size_t(count)) != size_t(count)) return;
      offset += count;
    }
  }

 private:
  int descriptor_;
};

void write_parts(const std::string& path, const Image& image, const std::vector<std::string>& channel_names,
                 const Metadata& metadata, const ExrOptions& options, OIIO::Filesystem::IOProxy& proxy) {
  const std::vector<Part> parts = parts_of(channel_names);
  std::vector<OIIO::ImageSpec> specs;
  for (const Part& part : parts) {
    std::vector<std::string> names;
    for (const int c : part.channels) names.push_back(channel_names[size_t(c)]);
    const bool is_first = specs.empty();
    specs.push_back(exr_spec(path, channels_of(image, part.channels), names,
                             metadata_of(part, is_first, metadata), options));
    specs.back().attribute("oiio:subimagename", part.name);
  }
  const MemoryFile file;
  const auto output = OIIO::ImageOutput::create("openexr");
  if (!output || file.name().empty())
    throw output_error(path,
                       fmt::format("cannot write an OpenEXR file of several parts: {}", OIIO::geterror()));
  bool is_well = output->open(file.name(), int(specs.size()), specs.data());
  for (size_t i = 0; is_well && i < parts.size(); ++i) {
    if (i > 0) is_well = output->open(file.name(), specs[i], OIIO::ImageOutput::AppendSubimage);
    is_well =
        is_well && output->write_image(OIIO::TypeFloat, channels_of(image, parts[i].channels).values.data());
  }
  if (!is_well || !output->close())
    throw output_error(path, fmt::format("cannot write image: {}", output->geterror()));
  file.copy_to(proxy);
}

void write_exr_to(const std::string& path, const Image& image, const std::vector<std::string>& channel_names,
                  const Metadata& metadata, const ExrOptions& options, OIIO::Filesystem::IOProxy& proxy) {
  const OIIO::ImageSpec spec = exr_spec(path, image, channel_names, metadata, options);
  const Image half = options.half ? limited(image, channel_names) : Image();
  const Image& values = options.half ? half : image;
  if (options.multipart)
    write_parts(path, values, channel_names, metadata, options, proxy);
  else
    write_image(path, "openexr", spec, values.values.data(), proxy);
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
  AtomicFile file(path);
  AtomicFileProxy proxy(path, file);
  try {
    write_exr_to(path, image, channel_names, metadata, options, proxy);
  } catch (const Error&) {
    if (!file.has_failed()) throw;  // else commit() knows more than the library does
  }
  file.commit();
}

std::vector<unsigned char> encode_exr(const Image& image, const std::vector<std::string>& channel_names,
                                      const Metadata& metadata, const ExrOptions& options) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  write_exr_to("picture", image, channel_names, metadata, options, memory);
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
