// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "vernier/export.h"
#include "vernier/image.h"

namespace vernier {

/// glTF sampler wrap modes (glTF 2.0, sampler.wrapS).
enum class WrapMode { repeat, mirrored_repeat, clamp_to_edge };
enum class FilterMode { nearest, linear };
enum class TexelEncoding { linear, srgb };

/// Pixels that lie on a disk (core/image/paged_image.h), for scenes that memory is too small for.
template <typename T>
class PagedImage;

/// The pixels of a texture, in the bits of its file.
using TexturePixels =
    std::variant<std::shared_ptr<const Image8>, std::shared_ptr<const Image16>,
                 std::shared_ptr<const PagedImage<uint8_t>>, std::shared_ptr<const PagedImage<uint16_t>>>;

/// Picture read at (u, v): u to the right, v downwards, (0,0) the outer corner of the first texel, as glTF
/// has it. Pixels are shared between textures of one image and stay in the bits that they came in.
class VERNIER_API Texture {
 public:
  /// `has_mips`: it may be read from smaller copies of itself where RenderSettings::texture_filter asks for
  /// it (glTF 2.0, sampler.minFilter).
  Texture(TexturePixels pixels, WrapMode wrap_s, WrapMode wrap_t, FilterMode filter, bool has_mips = true)
      : pixels_(std::move(pixels)), wrap_s_(wrap_s), wrap_t_(wrap_t), filter_(filter), has_mips_(has_mips) {}

  /// RGBA in [0,1]; missing channels: grey is repeated to RGB, alpha is 1. With `srgb`, RGB texels are
  /// decoded to linear light before filtering; alpha never is. Not finite coordinates read as 0.
  Vec4f sample(const Vec2f& uv, TexelEncoding encoding) const;

  const TexturePixels& pixels() const { return pixels_; }
  int width() const;
  int height() const;
  /// The picture of a texture known to be in memory and to have codes of type T.
  template <typename T = uint8_t>
  const BasicImage<T>& image() const {
    return *std::get<std::shared_ptr<const BasicImage<T>>>(pixels_);
  }
  WrapMode wrap_s() const { return wrap_s_; }
  WrapMode wrap_t() const { return wrap_t_; }
  FilterMode filter() const { return filter_; }
  bool has_mips() const { return has_mips_; }

 private:
  TexturePixels pixels_;
  WrapMode wrap_s_, wrap_t_;
  FilterMode filter_;
  bool has_mips_;
};

}  // namespace vernier
