#include "materials/material.h"

namespace vernier {
namespace {

/// KHR_texture_transform: translation * rotation * scale on column vectors, v downwards.
Vec2f transform_uv(const TextureUse& use, const Vec2f& uv) {
  const float u = uv.x * use.scale.x, v = uv.y * use.scale.y;
  if (use.rotation == 0) return {u + use.offset.x, v + use.offset.y};
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  return {c * u + s * v + use.offset.x, -s * u + c * v + use.offset.y};
}

Rgb rgb(const Vec4f& v) { return {v.x, v.y, v.z}; }

/// Beer-Lambert coefficient that leaves `color` after `distance` (KHR_materials_volume).
Rgb absorption_of(const MaterialDescription& d) {
  Rgb sigma(0, 0, 0);
  if (!std::isfinite(d.attenuation_distance) || !(d.attenuation_distance > 0)) return sigma;
  for (int c = 0; c < 3; ++c)
    sigma[c] = -std::log(std::max(d.attenuation_color[c], 1e-6f)) / d.attenuation_distance;
  return sigma;
}

/// An index of 0 stands for an infinite one (KHR_materials_ior).
float relative_index(const MaterialDescription& d) { return d.ior == 0 ? 1e6f : d.ior; }

}  // namespace

Material::Material(const MaterialDescription& description, std::span<const Texture> textures, bool has_colors)
    : description_(description), textures_(textures), has_colors_(has_colors) {
  const auto& d = description_;
  const bool bsdf_varies = has_colors || d.base_color_texture || d.metallic_roughness_texture ||
                           d.specular_texture || d.specular_color_texture || d.transmission_texture;
  is_constant_ = !bsdf_varies;
  needs_attributes_ = bsdf_varies || d.normal_texture || d.emissive_texture;
  is_emissive_ = d.unlit || !is_black(d.emissive);
  absorption_ = absorption_of(d);
  if (is_volume_boundary()) {
    energy_front_ = &GlassEnergy::of(relative_index(d));
    energy_back_ = &GlassEnergy::of(1 / relative_index(d));
  }
  if (is_constant_) {
    constant_front_ = make_bsdf({}, true);
    constant_back_ = make_bsdf({}, false);
  }
}

Vec4f Material::read(const TextureUse& use, const SurfaceAttributes& attributes,
                     TexelEncoding encoding) const {
  if (!use) return {1, 1, 1, 1};
  return textures_[size_t(use.texture)].sample(transform_uv(use, attributes.uv[size_t(use.texcoord)]),
                                               encoding);
}

Vec4f Material::base_color(const SurfaceAttributes& attributes) const {
  Vec4f color =
      description_.base_color * read(description_.base_color_texture, attributes, TexelEncoding::srgb);
  if (has_colors_) color *= attributes.color;
  return color;
}

Bsdf Material::bsdf(const SurfaceAttributes& attributes, bool front) const {
  if (is_constant_) return front ? constant_front_ : constant_back_;
  return make_bsdf(attributes, front);
}

Bsdf Material::make_bsdf(const SurfaceAttributes& attributes, bool front) const {
  const auto& d = description_;
  if (d.unlit) return Lambert{};
  const Rgb color = rgb(base_color(attributes));

  float metallic = d.metallic, roughness = d.roughness;
  if (d.metallic_roughness_texture) {
    const Vec4f texel = read(d.metallic_roughness_texture, attributes, TexelEncoding::linear);
    roughness *= texel.y;
    metallic *= texel.z;
  }
  const float alpha = square(std::clamp(roughness, 0.f, 1.f));
  const Ggx ggx{alpha, alpha};
  const Conductor metal{color, {1, 1, 1}, ggx};
  if (metallic >= 1) return metal;

  // KHR_materials_specular on top of KHR_materials_ior; an index of 0 asks for full reflectance.
  const float f90 = d.specular * read(d.specular_texture, attributes, TexelEncoding::linear).w;
  const Rgb specular_color =
      d.specular_color * rgb(read(d.specular_color_texture, attributes, TexelEncoding::srgb));
  Rgb f0;
  for (int c = 0; c < 3; ++c)
    f0[c] = (d.ior == 0 ? 1 : std::min(f0_from_ior(d.ior) * specular_color[c], 1.f)) * f90;
  const float transmission =
      d.transmission * read(d.transmission_texture, attributes, TexelEncoding::linear).x;

  if (transmission <= 0 && metallic <= 0 && f90 <= 0) return Lambert{color};
  const Plastic plastic{color, f0, {f90, f90, f90}, ggx};
  if (transmission <= 0 && metallic <= 0) return plastic;

  const bool thin = d.thickness <= 0;
  const float ior = relative_index(d);
  const Dielectric glass{
      thin || front ? ior : 1 / ior, ggx, color, specular_color * f90, thin, front ? energy_front_ : energy_back_};
  if (transmission >= 1 && metallic <= 0) return glass;
  return Mixture{
      metal, plastic, glass, metallic, (1 - metallic) * (1 - transmission), (1 - metallic) * transmission};
}

Rgb Material::emission(const SurfaceAttributes& attributes, bool front) const {
  if (!front && !description_.double_sided) return {0, 0, 0};
  if (description_.unlit) return rgb(base_color(attributes));
  if (!description_.emissive_texture) return description_.emissive;
  return description_.emissive * rgb(read(description_.emissive_texture, attributes, TexelEncoding::srgb));
}

float Material::coverage(const SurfaceAttributes& attributes) const {
  if (description_.alpha_mode == AlphaMode::opaque) return 1;
  const float alpha = base_color(attributes).w;
  if (description_.alpha_mode == AlphaMode::mask) return alpha >= description_.alpha_cutoff ? 1.f : 0.f;
  return alpha;
}

Vec3f Material::tangent_space_normal(const SurfaceAttributes& attributes) const {
  const Vec4f texel = read(description_.normal_texture, attributes, TexelEncoding::linear);
  const float scale = description_.normal_scale;
  const Vec3f n((2 * texel.x - 1) * scale, (2 * texel.y - 1) * scale, std::max(2 * texel.z - 1, 1e-3f));
  return normalize(n);
}

}  // namespace vernier
