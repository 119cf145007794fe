// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

#include "vernier/export.h"
#include "vernier/image.h"

namespace vernier {

/// glTF sampler wrap modes (glTF 2.0, sampler.wrapS).
enum class WrapMode { repeat, mirrored_repeat, clamp_to_edge };
enum class FilterMode { nearest, linear };
enum class TexelEncoding { linear, srgb };

/// Eight-bit picture read at (u, v): u to the right, v downwards, (0,0) the outer corner of the first texel,
/// as glTF has it. Pixels are shared between textures of one image and stay in 8 bits.
class VERNIER_API Texture {
 public:
  Texture(std::shared_ptr<const Image8> image, WrapMode wrap_s, WrapMode wrap_t, FilterMode filter)
      : image_(std::move(image)), wrap_s_(wrap_s), wrap_t_(wrap_t), filter_(filter) {}

  /// RGBA in [0,1]; missing channels: grey is repeated to RGB, alpha is 1. With `srgb`, RGB texels are
  /// decoded to linear light before filtering; alpha never is. Not finite coordinates read as 0.
  Vec4f sample(const Vec2f& uv, TexelEncoding encoding) const;

  const Image8& image() const { return *image_; }
  WrapMode wrap_s() const { return wrap_s_; }
  WrapMode wrap_t() const { return wrap_t_; }
  FilterMode filter() const { return filter_; }

 private:
  std::shared_ptr<const Image8> image_;
  WrapMode wrap_s_, wrap_t_;
  FilterMode filter_;
};

}  // namespace vernier
