// SPDX-License-Identifier: Apache-2.0
#include "vernier/texture.h"

#include <array>
#include <vector>

#include "core/image/paged_image.h"

namespace vernier {
namespace {

/// Values of the 256 codes of a channel, by TexelEncoding.
struct CodeTables {
  std::array<float, 256> linear, srgb;

  CodeTables() {
    for (int code = 0; code < 256; ++code) {
      linear[size_t(code)] = float(code) / 255;
      srgb[size_t(code)] = srgb_to_linear(float(code) / 255);
    }
  }
};
const CodeTables tables;

/// How codes of eight bits are read.
struct Codes8 {
  const float* color_table;

  explicit Codes8(TexelEncoding encoding)
      : color_table((encoding == TexelEncoding::srgb ? tables.srgb : tables.linear).data()) {}
  float color(uint8_t code) const { return color_table[code]; }
  static float number(uint8_t code) { return tables.linear[code]; }
};

/// How codes of sixteen bits are read. Their sRGB table is a quarter of a megabyte, made when first asked
/// for.
struct Codes16 {
  const float* color_table = nullptr;  ///< null: linear

  explicit Codes16(TexelEncoding encoding) {
    static const std::vector<float> srgb = [] {
      std::vector<float> table(65536);
      for (size_t code = 0; code < table.size(); ++code) table[code] = srgb_to_linear(number(uint16_t(code)));
      return table;
    }();
    if (encoding == TexelEncoding::srgb) color_table = srgb.data();
  }
  float color(uint16_t code) const { return color_table ? color_table[code] : number(code); }
  static float number(uint16_t code) { return float(code) / 65535; }
};

/// Brings a coordinate into [0, 1]; anything not finite becomes 0.
float wrapped(float coordinate, WrapMode mode) {
  if (!std::isfinite(coordinate)) return 0;
  switch (mode) {
    case WrapMode::repeat:
      return coordinate - std::floor(coordinate);
    case WrapMode::mirrored_repeat: {
      const float period = coordinate - 2 * std::floor(0.5f * coordinate);
      return period > 1 ? 2 - period : period;
    }
    default:
      return std::clamp(coordinate, 0.f, 1.f);
  }
}

/// Two neighbouring texels along one axis and the weight of the second.
struct Neighbors {
  int first, second;
  float weight;
};

// A call would return its parts by way of the stack, where reading them together waits for each to be
// written.
[[gnu::always_inline]] inline Neighbors neighbors(float coordinate, int size, WrapMode mode) {
  const float position = wrapped(coordinate, mode) * float(size) - 0.5f;
  const float first = std::floor(position);
  Neighbors n{int(first), int(first) + 1, position - first};
  // Past an edge a mirrored texture shows the edge texel again, as a clamped one does.
  const bool repeats = mode == WrapMode::repeat;
  if (n.first < 0) n.first = repeats ? size - 1 : 0;
  if (n.second >= size) n.second = repeats ? 0 : size - 1;
  return n;
}

int nearest(float coordinate, int size, WrapMode mode) {
  return std::min(int(wrapped(coordinate, mode) * float(size)), size - 1);
}

template <int channels, typename T, typename Codes>
Vec4f decoded(const T* texel, const Codes& codes) {
  if constexpr (channels <= 2) {
    const float gray = codes.color(texel[0]);
    return {gray, gray, gray, channels == 2 ? Codes::number(texel[channels - 1]) : 1.f};
  } else {
    return {codes.color(texel[0]), codes.color(texel[1]), codes.color(texel[2]),
            channels == 4 ? Codes::number(texel[channels - 1]) : 1.f};
  }
}

/// The texels that lie about a point.
template <typename T>
struct Quad {
  const T *upper_left, *upper_right, *lower_left, *lower_right;
};

template <int channels, typename T>
[[gnu::always_inline]] inline Quad<T> quad(const BasicImage<T>& image, const Neighbors& x,
                                           const Neighbors& y) {
  const size_t row = size_t(image.width) * channels;
  const T* upper = image.values.data() + size_t(y.first) * row;
  const T* lower = image.values.data() + size_t(y.second) * row;
  const size_t left = size_t(x.first) * channels, right = size_t(x.second) * channels;
  return {upper + left, upper + right, lower + left, lower + right};
}

template <int channels, typename T>
[[gnu::always_inline]] inline Quad<T> quad(const PagedImage<T>& image, const Neighbors& x,
                                           const Neighbors& y) {
  return {image.template texel<channels>(x.first, y.first), image.template texel<channels>(x.second, y.first),
          image.template texel<channels>(x.first, y.second),
          image.template texel<channels>(x.second, y.second)};
}

template <int channels, typename Picture, typename Codes>
Vec4f bilinear(const Picture& image, const Neighbors& x, const Neighbors& y, const Codes& codes) {
  const auto texels = quad<channels>(image, x, y);
  const Vec4f top = decoded<channels>(texels.upper_left, codes) * (1 - x.weight) +
                    decoded<channels>(texels.upper_right, codes) * x.weight;
  const Vec4f bottom = decoded<channels>(texels.lower_left, codes) * (1 - x.weight) +
                       decoded<channels>(texels.lower_right, codes) * x.weight;
  return top * (1 - y.weight) + bottom * y.weight;
}

template <typename Picture, typename Codes>
Vec4f interpolated(const Picture& image, int channels, const Neighbors& x, const Neighbors& y,
                   const Codes& codes) {
  switch (channels) {
    case 1:
      return bilinear<1>(image, x, y, codes);
    case 2:
      return bilinear<2>(image, x, y, codes);
    case 3:
      return bilinear<3>(image, x, y, codes);
    default:
      return bilinear<4>(image, x, y, codes);
  }
}

/// A picture's size and codes.
template <typename T>
struct Format {
  using Code = T;
  int width, height, channels;
};

template <typename T>
Format<T> format_of(const BasicImage<T>& image) {
  return {image.width, image.height, image.channels};
}

template <typename T>
Format<T> format_of(const PagedImage<T>& image) {
  return {image.width(), image.height(), image.channels()};
}

}  // namespace

int Texture::width() const {
  return std::visit([](const auto& image) { return format_of(*image).width; }, pixels_);
}

int Texture::height() const {
  return std::visit([](const auto& image) { return format_of(*image).height; }, pixels_);
}

Vec4f Texture::sample(const Vec2f& uv, TexelEncoding encoding) const {
  const auto read = [&](const auto& image) {
    const auto format = format_of(*image);
    Neighbors x, y;
    if (filter_ == FilterMode::nearest) {
      x.first = x.second = nearest(uv.x, format.width, wrap_s_);
      y.first = y.second = nearest(uv.y, format.height, wrap_t_);
      x.weight = y.weight = 0;
    } else {
      x = neighbors(uv.x, format.width, wrap_s_);
      y = neighbors(uv.y, format.height, wrap_t_);
    }
    if constexpr (std::is_same_v<typename decltype(format)::Code, uint8_t>)
      return interpolated(*image, format.channels, x, y, Codes8(encoding));
    else
      return interpolated(*image, format.channels, x, y, Codes16(encoding));
  };
  return std::visit(read, pixels_);
}

}  // namespace vernier
