// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "vernier/texture.h"

namespace vernier {

/// A parallelogram about a point of texture coordinates, by two sides that meet.
using UvArea = std::array<Vec2f, 2>;

/// Copies of a picture of sRGB colors, each half the size of the one before (rounded down), to a single
/// texel: every texel is the mean of the box that it covers in the copy before, in linear light, also where
/// sides are odd (Guthe and Heckbert 2005, "Non-Power-of-Two Mipmap Creation"). `by_alpha` weights texels by
/// their alpha, which says how much of the color there is; otherwise copies have no alpha. They lie where the
/// picture does.
std::vector<TexturePixels> make_mips(const TexturePixels& picture, bool by_alpha);

/// A texture of sRGB colors, to be read over an area (Williams 1983, "Pyramidal Parametrics").
///
/// What is read has the spread of the area and no more: the variance that a filter adds to where color comes
/// from is that of the area's box, s^2 / 12 for a side of s texels. Copy k, bilinearly read, adds
/// (4^k - 1) / 4 to what reading the picture itself does, so copies are mixed until 1 + s^2 / 3 is the mean
/// of their 4^k. A point is read as the texture is read without, with no step in between. Areas that are
/// longer than wide are read at several places along them (McCormack, Perry, Farkas and Jouppi 1999,
/// "Feline: Fast Elliptical Lines for Anisotropic Texture Mapping"), whose spread makes up the rest.
class MipPyramid {
 public:
  /// `mips` are make_mips() of its pixels. What is read `by_alpha` is a mean by that.
  MipPyramid(const Texture& texture, const std::vector<TexturePixels>& mips, bool by_alpha);

  Rgb sample(const Vec2f& uv, const UvArea& area) const;

 private:
  /// Of colors times their weights, and of these: over an area by its sides in texels, over a square of that
  /// many squared texels, and at a point of a copy.
  Vec4f sum_over(const Vec2f& p, const Vec2f& q, const Vec2f& uv) const;
  Vec4f sample_square(const Vec2f& uv, float side2) const;
  Vec4f read(size_t level, const Vec2f& uv) const;

  std::vector<Texture> levels_;  ///< the texture itself first
  bool by_alpha_;
  Vec2f size_;  ///< texels of that
};

}  // namespace vernier
