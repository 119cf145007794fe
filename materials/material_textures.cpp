// SPDX-License-Identifier: Apache-2.0
// What materials read of their textures: where, over what, and as what.
#include "materials/material.h"

namespace vernier {
namespace {

/// KHR_texture_transform: rotation * scale on column vectors, v downwards.
Vec2f turned_and_scaled(const TextureUse& use, const Vec2f& uv) {
  const float u = uv.x * use.scale.x, v = uv.y * use.scale.y;
  if (use.rotation == 0) return {u, v};
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  return {c * u + s * v, -s * u + c * v};
}

/// The same, and the offset.
Vec2f transform_uv(const TextureUse& use, const Vec2f& uv) { return turned_and_scaled(use, uv) + use.offset; }

Rgb rgb(const Vec4f& v) { return {v.x, v.y, v.z}; }

}  // namespace

Vec2f SurfaceAttributes::further_texcoord(int set) const {
  if (!mesh || size_t(set) >= mesh->texcoord_set_count()) return {0, 0};
  const auto& texcoords = mesh->texcoord_set(size_t(set));
  if (texcoords.empty()) return {0, 0};
  const auto& [a, b, c] = mesh->triangles[triangle];
  const auto [u, v] = std::pair(barycentrics.x, barycentrics.y);
  return texcoords[a] * (1 - u - v) + texcoords[b] * u + texcoords[c] * v;
}

UvArea SurfaceAttributes::texcoord_area(int set) const {
  if (size_t(set) >= mesh->texcoord_set_count() || mesh->texcoord_set(size_t(set)).empty())
    return {Vec2f(0, 0), Vec2f(0, 0)};
  const auto& texcoords = mesh->texcoord_set(size_t(set));
  const auto& [a, b, c] = mesh->triangles[triangle];
  const Vec2f along_u = texcoords[b] - texcoords[a], along_v = texcoords[c] - texcoords[a];
  const auto side = [&](const Vec2f& s) { return along_u * s.x + along_v * s.y; };
  return {side(footprint[0]), side(footprint[1])};
}

Vec4f Material::read(const TextureUse& use, const SurfaceAttributes& attributes,
                     TexelEncoding encoding) const {
  if (!use) return {1, 1, 1, 1};
  return textures_[size_t(use.texture)].sample(transform_uv(use, attributes.texcoord(use.texcoord)),
                                               encoding);
}

Rgb Material::read_color(const TextureUse& use, const SurfaceAttributes& attributes) const {
  if (attributes.has_footprint) [[unlikely]]
    return read_area(use, attributes, false);
  return rgb(read(use, attributes, TexelEncoding::srgb));
}

Rgb Material::read_area(const TextureUse& use, const SurfaceAttributes& attributes, bool by_alpha) const {
  const MipPyramid* mips = use && mips_ ? mips_->find(use.texture, by_alpha) : nullptr;
  if (!mips) return rgb(read(use, attributes, TexelEncoding::srgb));
  const auto [p, q] = attributes.texcoord_area(use.texcoord);
  return mips->sample(transform_uv(use, attributes.texcoord(use.texcoord)),
                      {turned_and_scaled(use, p), turned_and_scaled(use, q)});
}

std::vector<Material::ColorTexture> Material::color_textures() const {
  const auto& d = description_;
  std::vector<ColorTexture> textures;
  if (d.base_color_texture) textures.push_back({d.base_color_texture.texture, !is_opaque()});
  for (const TextureUse* use : {&d.emissive_texture, &d.specular_color_texture, &d.sheen_color_texture,
                                &d.diffuse_transmission_color_texture})
    if (*use) textures.push_back({use->texture, false});
  return textures;
}

Vec4f Material::base_color(const SurfaceAttributes& attributes) const {
  Vec4f color = read(description_.base_color_texture, attributes, TexelEncoding::srgb);
  if (attributes.has_footprint) [[unlikely]] {
    const Rgb mean = read_area(description_.base_color_texture, attributes, !is_opaque());
    color = {mean.x, mean.y, mean.z, color.w};
  }
  color = description_.base_color * color;
  if (has_colors_) color *= attributes.color;
  return color;
}

float Material::emissive_texels(const std::array<SurfaceAttributes, 3>& corners) const {
  const auto texels = [&](const TextureUse& use) {
    if (!use) return 0.f;
    const auto at = [&](size_t i) { return transform_uv(use, corners[i].texcoord(use.texcoord)); };
    const Vec2f a = at(1) - at(0), b = at(2) - at(0);
    const Texture& texture = textures_[size_t(use.texture)];
    return std::abs(a.x * b.y - a.y * b.x) / 2 * (float(texture.width()) * float(texture.height()));
  };
  const float emitted = texels(description_.emissive_texture);
  return is_opaque() ? emitted : std::max(emitted, texels(description_.base_color_texture));
}

float Material::coverage(const SurfaceAttributes& attributes) const {
  if (description_.alpha_mode == AlphaMode::opaque) return 1;
  const float alpha = base_color(attributes).w;
  if (description_.alpha_mode == AlphaMode::mask) return alpha >= description_.alpha_cutoff ? 1.f : 0.f;
  return std::clamp(alpha, 0.f, 1.f);
}

Vec3f Material::read_normal(const TextureUse& use, float scale, const SurfaceAttributes& attributes) const {
  if (!use) return {0, 0, 1};
  const Vec4f texel = read(use, attributes, TexelEncoding::linear);
  return normalize(
      Vec3f((2 * texel.x - 1) * scale, (2 * texel.y - 1) * scale, std::max(2 * texel.z - 1, 1e-3f)));
}

Vec3f Material::tangent_space_normal(const SurfaceAttributes& attributes) const {
  return read_normal(description_.normal_texture, description_.normal_scale, attributes);
}

Vec3f Material::tangent_space_coat_normal(const SurfaceAttributes& attributes) const {
  return read_normal(description_.clearcoat_normal_texture, description_.clearcoat_normal_scale, attributes);
}

Vec2f Material::anisotropy_direction(const SurfaceAttributes& attributes) const {
  const float c = std::cos(description_.anisotropy_rotation), s = std::sin(description_.anisotropy_rotation);
  if (!description_.anisotropy_texture) return {c, s};
  const Vec4f texel = read(description_.anisotropy_texture, attributes, TexelEncoding::linear);
  const Vec2f d(2 * texel.x - 1, 2 * texel.y - 1);
  const float length2 = d.x * d.x + d.y * d.y;
  if (length2 < 1e-6f) return {c, s};
  return Vec2f(c * d.x - s * d.y, s * d.x + c * d.y) * (1 / std::sqrt(length2));
}

}  // namespace vernier
