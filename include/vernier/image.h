// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vernier/export.h"
#include "vernier/math.h"

namespace vernier {

/// Row-major picture, top row first, `channels` interleaved values a pixel.
template <typename T>
struct BasicImage {
  int width = 0, height = 0, channels = 0;
  std::vector<T> values;

  BasicImage() = default;
  BasicImage(int w, int h, int c) : width(w), height(h), channels(c), values(size_t(w) * h * c) {}

  T* pixel(int x, int y) { return &values[(size_t(y) * width + x) * channels]; }
  const T* pixel(int x, int y) const { return &values[(size_t(y) * width + x) * channels]; }
  bool empty() const { return values.empty(); }
};

/// Float picture; three-channel ones hold scene-linear Rec.709 unless stated.
using Image = BasicImage<float>;
/// Eight-bit picture as decoded from a texture file, in the file's own encoding; 1 to 4 channels.
using Image8 = BasicImage<uint8_t>;
/// The same of files that have more than eight bits a channel.
using Image16 = BasicImage<uint16_t>;

inline Rgb rgb_at(const Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

/// sRGB transfer function to linear light, encoded value in [0,1] (IEC 61966-2-1).
inline float srgb_to_linear(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}
/// Linear light in [0,1] to the sRGB transfer function.
inline float linear_to_srgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// Text and numbers stored in an image file's header, by attribute name.
using Metadata = std::map<std::string, std::string>;

/// Where a picture lies in a larger one that it is a part of.
struct PicturePlace {
  int x = 0, y = 0;                     ///< of its upper left pixel
  int full_width = 0, full_height = 0;  ///< of the larger one; 0: there is none
};

/// All channels of a file and the texts in its header.
struct VERNIER_API LayeredImage {
  Image image;
  std::vector<std::string> channel_names;  ///< as many as image.channels
  Metadata metadata;
  bool linear = false;  ///< the file stores floating-point numbers, not display values in [0, 1]
  PicturePlace place{};

  /// R, G and B, else the first three channels, else grey repeated.
  Image rgb() const;
  /// The channels NAME.R, NAME.G, NAME.B or NAME.X, NAME.Y, NAME.Z; empty when one is missing.
  std::optional<Image> layer(const std::string& name) const;
  /// The channel NAME as a picture of one channel; empty when it is missing.
  std::optional<Image> single(const std::string& name) const;
  /// Adds the channels of a picture of the same size, which get these names.
  void append(const Image& more, const std::vector<std::string>& names);

 private:
  int channel(const std::string& name) const;
  Image select(const std::array<int, 3>& chosen) const;
};

}  // namespace vernier
