// SPDX-License-Identifier: Apache-2.0
#include "materials/mip_pyramid.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "materials/texture_pixels.h"

namespace vernier {
namespace {

/// The longest area that is read in full, in widths; what is longer is read as wide as that makes it.
constexpr int most_places = 16;
/// Texels: a smaller area is a point to what a texture can tell apart, a larger one all of it.
constexpr float least_side = 1 / 16.f, most_side = 1e9f;

template <typename T>
const std::vector<float>& light_of_codes() {
  static const std::vector<float> table = [] {
    constexpr int most = std::numeric_limits<T>::max();
    std::vector<float> light(size_t(most) + 1);
    for (int code = 0; code <= most; ++code) light[size_t(code)] = srgb_to_linear(float(code) / float(most));
    return light;
  }();
  return table;
}

template <typename T>
T code_of(float value) {
  constexpr auto most = float(std::numeric_limits<T>::max());
  return T(std::lround(std::clamp(value, 0.f, 1.f) * most));
}

/// What of the texels from 2 i on the i-th of half as many covers. Of an odd number, 2 m + 1, each covers a
/// little more than two.
std::array<float, 3> parts(int size, int i) {
  if (size == 1) return {1, 0, 0};
  if (size % 2 == 0) return {0.5f, 0.5f, 0};
  const int half = size / 2;
  const auto n = float(size), m = float(half);
  return {(m - float(i)) / n, m / n, float(i + 1) / n};
}

/// Sums over a box.
struct BoxSums {
  std::array<float, 3> color{}, weighted{};  ///< light, and the same times alpha
  float alpha = 0;

  template <typename T>
  void add(const BasicImage<T>& image, int x, int y, float part) {
    const T* texel = image.pixel(x, y);
    const int colors = image.channels <= 2 ? 1 : 3;
    const float alpha_part =
        image.channels % 2 == 0 ? part * float(texel[colors]) / float(std::numeric_limits<T>::max()) : part;
    alpha += alpha_part;
    for (int c = 0; c < colors; ++c) {
      const float light = light_of_codes<T>()[texel[c]];
      color[size_t(c)] += part * light;
      weighted[size_t(c)] += alpha_part * light;
    }
  }
};

template <typename T>
BasicImage<T> halved(const BasicImage<T>& image, bool by_alpha) {
  const int colors = image.channels <= 2 ? 1 : 3;
  const bool keeps_alpha = by_alpha && image.channels % 2 == 0;
  BasicImage<T> half(std::max(image.width / 2, 1), std::max(image.height / 2, 1), colors + keeps_alpha);
  parallel_for_isolated(size_t(half.height), [&](size_t row) {
    const int y = int(row);
    const auto down = parts(image.height, y);
    for (int x = 0; x < half.width; ++x) {
      const auto across = parts(image.width, x);
      BoxSums sums;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
          if (const float part = across[size_t(i)] * down[size_t(j)]; part > 0)
            sums.add(image, 2 * x + i, 2 * y + j, part);
      const bool weighted = keeps_alpha && sums.alpha > 0;
      T* texel = half.pixel(x, y);
      for (int c = 0; c < colors; ++c)
        texel[c] = code_of<T>(
            linear_to_srgb(weighted ? sums.weighted[size_t(c)] / sums.alpha : sums.color[size_t(c)]));
      if (keeps_alpha) texel[colors] = code_of<T>(sums.alpha);
    }
  });
  return half;
}

/// Texels of which nothing is covered get the color of what lies around them, which interpolation mixes in.
template <typename T>
void fill_holes(BasicImage<T>& image, const BasicImage<T>& half) {
  if (image.channels % 2 != 0) return;
  const int colors = image.channels - 1;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (T* texel = image.pixel(x, y); texel[colors] == 0)
        std::copy_n(half.pixel(std::min(x / 2, half.width - 1), std::min(y / 2, half.height - 1)), colors,
                    texel);
}

/// An area by the variances of its box, times 12, along the axes of its ellipse, texels^2.
struct Ellipse {
  float longest2, shortest2;
  Vec2f along;  ///< unit, the longest axis
};

Ellipse ellipse_of(const Vec2f& p, const Vec2f& q) {
  const float xx = p.x * p.x + q.x * q.x, xy = p.x * p.y + q.x * q.y, yy = p.y * p.y + q.y * q.y;
  const float mean = (xx + yy) / 2, difference = (xx - yy) / 2, root = std::hypot(difference, xy);
  Vec2f along = difference >= 0 ? Vec2f(difference + root, xy) : Vec2f(xy, root - difference);
  along = root > 0 ? along * (1 / std::hypot(along.x, along.y)) : Vec2f(1, 0);
  const float longest2 = mean + root;
  // The product of both is exact where their difference would be rounding.
  return {longest2, square(p.x * q.y - p.y * q.x) / longest2, along};
}

}  // namespace

std::vector<TexturePixels> make_mips(const TexturePixels& picture, bool by_alpha) {
  std::vector<TexturePixels> mips;
  const std::shared_ptr<PagedFile> file = file_of(picture);
  std::visit(
      [&]<typename T>(const std::shared_ptr<const BasicImage<T>>& image) {
        std::vector<std::shared_ptr<BasicImage<T>>> levels;
        const BasicImage<T>* last = image.get();
        while (last->width > 1 || last->height > 1) {
          levels.push_back(std::make_shared<BasicImage<T>>(halved(*last, by_alpha)));
          last = levels.back().get();
        }
        for (size_t i = levels.size(); i-- > 1;) fill_holes(*levels[i - 1], *levels[i]);
        for (auto& level : levels) mips.push_back(in_file(std::exchange(level, nullptr), file));
      },
      in_memory(picture));
  return mips;
}

MipPyramid::MipPyramid(const Texture& texture, const std::vector<TexturePixels>& mips, bool by_alpha)
    : levels_{texture}, by_alpha_(by_alpha), size_(float(texture.width()), float(texture.height())) {
  for (const TexturePixels& mip : mips)
    levels_.emplace_back(mip, texture.wrap_s(), texture.wrap_t(), FilterMode::linear);
}

Vec4f MipPyramid::read(size_t level, const Vec2f& uv) const {
  const Vec4f texel = levels_[level].sample(uv, TexelEncoding::srgb);
  const float weight = by_alpha_ ? texel.w : 1;
  return {texel.x * weight, texel.y * weight, texel.z * weight, weight};
}

Vec4f MipPyramid::sample_square(const Vec2f& uv, float side2) const {
  const float wanted = 1 + side2 / 3;
  const auto level = size_t(std::ilogb(wanted) / 2);
  if (level + 1 >= levels_.size()) return read(levels_.size() - 1, uv);
  const float next = (std::ldexp(wanted, -2 * int(level)) - 1) / 3;
  return read(level, uv) * (1 - next) + read(level + 1, uv) * next;
}

Rgb MipPyramid::sample(const Vec2f& uv, const UvArea& area) const {
  const Vec2f p = area[0] * size_, q = area[1] * size_;
  const float reach = std::abs(p.x) + std::abs(p.y) + std::abs(q.x) + std::abs(q.y);
  const Vec4f sum = reach > least_side ? sum_over(p, q, uv) : Vec4f(0, 0, 0, 0);
  if (sum.w > 0) return Rgb(sum.x, sum.y, sum.z) / sum.w;
  const Vec4f texel = levels_[0].sample(uv, TexelEncoding::srgb);
  return {texel.x, texel.y, texel.z};
}

Vec4f MipPyramid::sum_over(const Vec2f& p, const Vec2f& q, const Vec2f& uv) const {
  if (std::max({std::abs(p.x), std::abs(p.y), std::abs(q.x), std::abs(q.y)}) > most_side)
    return read(levels_.size() - 1, uv);
  const auto [longest2, shortest2, along] = ellipse_of(p, q);
  // Places nearer to each other than texels tell nothing new.
  const float ratio = std::sqrt(longest2 / std::max(shortest2, 1.f));
  const int places = int(std::clamp(std::ceil(ratio), 1.f, float(most_places)));
  if (places == 1) return sample_square(uv, (longest2 + shortest2) / 2);
  const float side2 = std::max(shortest2, longest2 / square(float(most_places)));
  const Vec2f step = along * (std::sqrt((longest2 - side2) / float(places * places - 1))) / size_;
  Vec4f sum(0, 0, 0, 0);
  for (int i = 0; i < places; ++i)
    sum += sample_square(uv + step * (float(i) - float(places - 1) / 2), side2);
  return sum;
}

}  // namespace vernier
