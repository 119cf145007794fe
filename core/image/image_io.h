// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vernier/image.h"

namespace vernier {

/// Caps that an image header must satisfy before anything is decoded. A picture of more than 2^24 pixels
/// whose file has under a 4096th as many bytes as values (AVIF: a 131,072nd) is refused too, so that a small
/// hostile file cannot ask for gigabytes.
struct ImageLimits {
  int64_t max_pixels = int64_t{1} << 28;
  std::string_view advice = "scale it down";  ///< to who has a larger one
};

/// Reads any file OpenImageIO knows as float RGB, values as stored: HDR and EXR files are linear already,
/// eight- and sixteen-bit ones are divided by their largest value and keep their transfer function. Channels
/// named R, G, B where there are such, else the first three, else grey repeated; alpha is dropped. Outside
/// OpenEXR's data window the picture is black. Throws Error(input) naming the file.
Image read_image(const std::string& path, const ImageLimits& limits = {});

/// As read_image, with every channel of the file's first part. Where an OpenEXR file holds a part of a
/// picture, it is that part, and `place` says where it lies.
LayeredImage read_layers(const std::string& path, const ImageLimits& limits = {});

/// A part of a picture in its place, and black around it.
Image whole_picture(Image part, const PicturePlace& place);

/// The texts in the header of an image file, whose pixels are not read; empty when it is none. JPEG files
/// hold them as lines of their description.
std::optional<Metadata> read_image_texts(const std::string& path);

/// A picture in the bits of its file.
using CodedImage = std::variant<Image8, Image16>;

/// A picture as far as its file has it.
struct PartialImage {
  CodedImage image;
  std::string damage;  ///< empty: whole; else what is wrong with the file: "the JPEG file is truncated, ..."
};

/// Decodes a PNG, JPEG, WebP or AVIF held in memory, in the file's own encoding, 1 to 4 channels,
/// unassociated alpha. Files with more than 8 bits a channel give 16, unless all of their codes are eight-bit
/// ones spread over sixteen. `name` is what errors call it. What a truncated file still holds is shown, as
/// browsers do; it is an error when that is nothing at all, and of AVIF.
PartialImage decode_partial_image(std::span<const uint8_t> bytes, const std::string& name,
                                  const ImageLimits& limits = {});

/// The same of a whole file; a truncated one is an error.
CodedImage decode_whole_image(std::span<const uint8_t> bytes, const std::string& name,
                              const ImageLimits& limits = {});

/// Largest value of a 16-bit float.
inline constexpr float largest_half = 65504;

/// How the pixels of an OpenEXR file are stored.
struct ExrOptions {
  bool half = false;  ///< R, G, B and A in 16 bits, values limited to +-largest_half; other channels keep 32
  std::string compression = "zip";  ///< by OpenImageIO's name, with a level after a colon where it has one
  PicturePlace place{};             ///< the data window in the display window
  /// A part of the file for R, G, B and A, and one for each group of channels of one name before the dot.
  bool multipart = false;
};

/// Writes float channels as OpenEXR. `channel_names` has image.channels entries ("R", "G", "B", "albedo.R",
/// ...). Replaces `path` wholly or not at all (core/base/atomic_file.h). Throws Error(output).
void write_exr(const std::string& path, const Image& image, const std::vector<std::string>& channel_names,
               const Metadata& metadata, const ExrOptions& options = {});

/// Writes display-encoded 8-bit values as PNG or JPEG by the extension of `path`, atomically like write_exr.
/// PNG keeps each metadata entry as a text chunk, JPEG all of them as lines of its ImageDescription.
void write_image8(const std::string& path, const Image8& image, const Metadata& metadata);

// The bytes of such files. `format` is "png" or "jpg".
std::vector<unsigned char> encode_exr(const Image& image, const std::vector<std::string>& channel_names,
                                      const Metadata& metadata, const ExrOptions& options = {});
std::vector<unsigned char> encode_image8(const std::string& format, const Image8& image,
                                         const Metadata& metadata = {});

/// Throws Error(output) unless the name ends in .exr, .png, .jpg or .jpeg.
void check_image_name(const std::string& path);

/// Throws Error(output) unless a .exr, .png, .jpg or .jpeg file can be written in that folder; called before
/// rendering so that hours are not lost to a misspelt folder.
void check_writable_image(const std::string& path);

}  // namespace vernier
