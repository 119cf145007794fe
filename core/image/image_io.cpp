// SPDX-License-Identifier: Apache-2.0
#include "core/image/image_io.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/image/image_decode.h"
#include "vernier/error.h"

namespace vernier {
namespace {

namespace fs = std::filesystem;

Error input_error(const std::string& file, const std::string& problem) {
  return Error(ErrorKind::input, file, {}, problem);
}

std::vector<uint8_t> read_bytes(const std::string& path, size_t at_most = SIZE_MAX) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw input_error(path, "is a folder; expected an image file");
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw input_error(path, "is not a regular file; expected an image file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw input_error(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::vector<uint8_t> bytes(std::min<uint64_t>(at_most, fs::file_size(path, error)));
  stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
  bytes.resize(size_t(stream.gcount()));
  return bytes;
}

OIIO::ImageInput::unique_ptr open_file(const std::string& path, const ImageLimits& limits) {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OIIO::ImageInput::open(path, &config);
  if (!input) throw input_error(path, fmt::format("cannot read as an image: {}", OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.depth > 1 || spec.deep)
    throw input_error(path, "volume and deep images cannot be used; expected a flat one");
  check_image_size(path, spec.width, spec.height, spec.nchannels, fs::file_size(path), limits);
  check_image_size(path, spec.full_width, spec.full_height, spec.nchannels, fs::file_size(path), limits);
  return input;
}

struct PlacedImage {
  Image image;
  PicturePlace place;
};

// The picture that a file means. OpenEXR's data window may cover only part of it, or more than it; other
// formats' offsets are page positions and mean nothing here.
PlacedImage read_picture(OIIO::ImageInput& input, const std::string& path) {
  const OIIO::ImageSpec spec = input.spec();
  Image stored(spec.width, spec.height, spec.nchannels);
  if (!input.read_image(input.current_subimage(), 0, 0, spec.nchannels, OIIO::TypeFloat,
                        stored.values.data()))
    throw input_error(path, fmt::format("cannot decode image, it is damaged: {}", input.geterror()));
  if (std::strcmp(input.format_name(), "openexr") != 0 || spec.roi() == spec.roi_full()) return {stored, {}};
  const OIIO::ROI shown = OIIO::roi_intersection(spec.roi(), spec.roi_full());
  if (shown.npixels() == 0) return {Image(spec.full_width, spec.full_height, spec.nchannels), {}};
  Image part(shown.width(), shown.height(), spec.nchannels);
  for (int y = 0; y < part.height; ++y)
    std::copy_n(stored.pixel(shown.xbegin - spec.x, shown.ybegin - spec.y + y),
                size_t(part.width) * part.channels, part.pixel(0, y));
  if (shown == spec.roi_full()) return {std::move(part), {}};
  return {std::move(part),
          {shown.xbegin - spec.full_x, shown.ybegin - spec.full_y, spec.full_width, spec.full_height}};
}

// The other parts of an OpenEXR file as more channels of the picture. Other programs leave the name of a part
// out of those of its channels; a part of another size is no layer of this picture.
void append_parts(OIIO::ImageInput& input, const std::string& path, LayeredImage& picture) {
  if (std::strcmp(input.format_name(), "openexr") != 0) return;
  for (int part = 1; input.seek_subimage(part, 0); ++part) {
    const PlacedImage more = read_picture(input, path);
    const bool fits = more.image.width == picture.image.width && more.image.height == picture.image.height &&
                      more.place.x == picture.place.x && more.place.y == picture.place.y;
    if (!fits) continue;
    const std::string name = input.spec().get_string_attribute("oiio:subimagename");
    std::vector<std::string> names = input.spec().channelnames;
    const auto& taken = picture.channel_names;
    for (std::string& channel : names)
      if (std::find(taken.begin(), taken.end(), channel) != taken.end()) channel.insert(0, name + ".");
    picture.append(more.image, names);
  }
}

// Header texts that a picture may carry on to another file: not the layout of this one.
Metadata texts(const OIIO::ImageSpec& spec) {
  Metadata metadata;
  for (const auto& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    const bool layout = name.starts_with("oiio:") || name.starts_with("openexr:") || name == "compression";
    if (attribute.type() == OIIO::TypeString && !layout) metadata[name] = attribute.get_string();
  }
  return metadata;
}

std::vector<std::string> plain_names(int channels) {
  const std::array<std::vector<std::string>, 5> names{
      {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
  return names[size_t(std::min(channels, 4))];
}

}  // namespace

Image LayeredImage::select(const std::array<int, 3>& chosen) const {
  Image selected(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (size_t c = 0; c < 3; ++c) selected.pixel(x, y)[c] = image.pixel(x, y)[chosen[c]];
  return selected;
}

int LayeredImage::channel(const std::string& name) const {
  const auto found = std::find(channel_names.begin(), channel_names.end(), name);
  return found == channel_names.end() ? -1 : int(found - channel_names.begin());
}

Image LayeredImage::rgb() const {
  const std::array<int, 3> named{channel("R"), channel("G"), channel("B")};
  if (*std::min_element(named.begin(), named.end()) >= 0) return select(named);
  return select(image.channels >= 3 ? std::array<int, 3>{0, 1, 2} : std::array<int, 3>{0, 0, 0});
}

std::optional<Image> LayeredImage::layer(const std::string& name) const {
  for (const char* axes : {"RGB", "XYZ"}) {
    const std::array<int, 3> named{channel(name + '.' + axes[0]), channel(name + '.' + axes[1]),
                                   channel(name + '.' + axes[2])};
    if (*std::min_element(named.begin(), named.end()) >= 0) return select(named);
  }
  return std::nullopt;
}

std::optional<Image> LayeredImage::single(const std::string& name) const {
  const int chosen = channel(name);
  if (chosen < 0) return std::nullopt;
  Image result(image.width, image.height, 1);
  for (size_t i = 0; i < result.values.size(); ++i)
    result.values[i] = image.values[i * size_t(image.channels) + size_t(chosen)];
  return result;
}

void LayeredImage::append(const Image& more, const std::vector<std::string>& names) {
  Image joined(image.width, image.height, image.channels + more.channels);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      float* out = std::copy_n(image.pixel(x, y), image.channels, joined.pixel(x, y));
      std::copy_n(more.pixel(x, y), more.channels, out);
    }
  image = std::move(joined);
  channel_names.insert(channel_names.end(), names.begin(), names.end());
}

LayeredImage read_layers(const std::string& path, const ImageLimits& limits) {
  LayeredImage result;
  std::vector<uint8_t> bytes = read_bytes(path, 32);
  if (parse_image_header(bytes)) {
    bytes = read_bytes(path);
    result.image = decode_image(bytes, *parse_image_header(bytes), path, limits);
    result.channel_names = plain_names(result.image.channels);
    return result;
  }
  const auto input = open_file(path, limits);
  const OIIO::ImageSpec spec = input->spec();
  PlacedImage picture = read_picture(*input, path);
  result.image = std::move(picture.image);
  result.place = picture.place;
  result.channel_names = spec.channelnames;
  result.metadata = texts(spec);
  result.linear = spec.format.is_floating_point();
  append_parts(*input, path, result);
  return result;
}

Image whole_picture(Image part, const PicturePlace& place) {
  if (place.full_width == 0) return part;
  Image whole(place.full_width, place.full_height, part.channels);
  for (int y = 0; y < part.height; ++y)
    std::copy_n(part.pixel(0, y), size_t(part.width) * part.channels, whole.pixel(place.x, place.y + y));
  return whole;
}

std::optional<Metadata> read_image_texts(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) {
    OIIO::geterror();  // which would be said to be another failure's
    return std::nullopt;
  }
  Metadata metadata = texts(input->spec());
  std::istringstream lines(metadata["ImageDescription"]);
  constexpr std::string_view separator = ": ";
  for (std::string line; std::getline(lines, line);)
    if (const size_t end = line.find(separator); end != std::string::npos)
      metadata.emplace(line.substr(0, end), line.substr(end + separator.size()));
  return metadata;
}

Image read_image(const std::string& path, const ImageLimits& limits) {
  const LayeredImage read = read_layers(path, limits);
  return whole_picture(read.rgb(), read.place);
}

}  // namespace vernier
