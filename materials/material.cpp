// SPDX-License-Identifier: Apache-2.0
#include "materials/material.h"

namespace vernier {
namespace {

Rgb rgb(const Vec4f& v) { return {v.x, v.y, v.z}; }

/// Beer-Lambert coefficient that leaves `color` after `distance` (KHR_materials_volume).
Rgb extinction_of(const MaterialDescription& d) {
  Rgb sigma(0, 0, 0);
  if (!std::isfinite(d.attenuation_distance) || !(d.attenuation_distance > 0)) return sigma;
  for (int c = 0; c < 3; ++c)
    sigma[c] = -std::log(std::max(d.attenuation_color[c], 1e-6f)) / d.attenuation_distance;
  return sigma;
}

/// An index of 0 stands for an infinite one (KHR_materials_ior).
float relative_index(const MaterialDescription& d) { return d.ior == 0 ? 1e6f : d.ior; }

/// Indices of refraction for red, green and blue: a spread between blue and red of (n - 1) / Abbe number
/// about the index itself (KHR_materials_dispersion).
Rgb dispersed_ior(const MaterialDescription& d) {
  const float half_spread = (d.ior - 1) * 0.025f * d.dispersion;
  return {std::max(d.ior - half_spread, 1.f), d.ior, d.ior + half_spread};
}

/// Any of these makes the scattering depend on the place.
bool has_bsdf_texture(const MaterialDescription& d) {
  return d.base_color_texture || d.metallic_roughness_texture || d.diffuse_roughness_texture ||
         d.specular_texture || d.specular_color_texture || d.transmission_texture || d.clearcoat_texture ||
         d.clearcoat_roughness_texture || d.sheen_color_texture || d.sheen_roughness_texture ||
         d.anisotropy_texture || d.iridescence_texture || d.iridescence_thickness_texture ||
         d.diffuse_transmission_texture || d.diffuse_transmission_color_texture;
}

int texcoord_of_tangents(const MaterialDescription& d) {
  if (d.normal_texture) return d.normal_texture.texcoord;
  if (d.clearcoat_normal_texture) return d.clearcoat_normal_texture.texcoord;
  return d.anisotropy_texture.texcoord;
}

}  // namespace

Material::Material(const MaterialDescription& description, std::span<const Texture> textures, bool has_colors,
                   const ColorMips* mips)
    : description_(description), textures_(textures), mips_(mips), has_colors_(has_colors) {
  const auto& d = description_;
  const bool bsdf_varies = has_colors || has_bsdf_texture(d);
  needs_attributes_ = bsdf_varies || has_normal_maps() || d.emissive_texture;
  is_emissive_ = d.unlit || !is_black(d.emissive);
  tangent_texcoord_ = texcoord_of_tangents(d);
  extinction_ = extinction_of(d);
  if (d.transmission > 0)
    for (const bool front : {false, true}) sides_[front] = make_side(front, {1, 1, 1});
  // Under a normal map the coat's normal varies in the frame of the base.
  is_constant_ = !bsdf_varies && !(has_coat() && has_normal_maps());
  if (is_constant_) {
    constant_front_ = make_bsdf({}, {.front = true});
    constant_back_ = make_bsdf({}, {.front = false});
  }
}

Rgb Material::interior_ior() const {
  const auto& d = description_;
  if (!is_volume_boundary() || d.transmission <= 0) return {1, 1, 1};
  if (d.dispersion <= 0 || d.ior == 0) return Rgb(relative_index(d));
  return dispersed_ior(d);
}

bool Material::may_be_clear() const {
  const auto& d = description_;
  if (d.transmission <= 0 || d.unlit || is_volume_boundary()) return false;
  return d.metallic_roughness_texture || square(d.roughness) < Dielectric::clear_limit;
}

bool Material::may_be_sharp() const {
  const auto& d = description_;
  const auto is_sharp = [](const TextureUse& texture, float roughness) {
    return texture || square(roughness) < Dielectric::clear_limit;
  };
  return !d.unlit && (is_sharp(d.metallic_roughness_texture, d.roughness) ||
                      (has_coat() && is_sharp(d.clearcoat_roughness_texture, d.clearcoat_roughness)));
}

Material::Side Material::make_side(bool front, const Rgb& outside_ior) const {
  const bool thin = !is_volume_boundary();
  const Rgb inside = thin ? Rgb(relative_index(description_)) : interior_ior();
  const auto eta = [&](int c) {
    return front || thin ? inside[c] / outside_ior[c] : outside_ior[c] / inside[c];
  };
  Side side;
  side.eta = eta(1);
  if (thin) return side;
  side.energy = &DielectricAlbedo::of(side.eta);
  if (eta(0) != side.eta || eta(2) != side.eta) side.dispersion = &Dispersion::of({eta(0), eta(1), eta(2)});
  return side;
}

Material::Side Material::side(const BsdfContext& context) const {
  if (context.outside_ior == Rgb(1, 1, 1)) return sides_[context.front];
  return make_side(context.front, context.outside_ior);
}

Bsdf Material::bsdf(const SurfaceAttributes& attributes, const BsdfContext& context) const {
  if (is_constant_ && !context.channel && context.outside_ior == Rgb(1, 1, 1))
    return context.front ? constant_front_ : constant_back_;
  return make_bsdf(attributes, context);
}

Bsdf Material::make_bsdf(const SurfaceAttributes& attributes, const BsdfContext& context) const {
  if (description_.unlit) return Lambert{};
  const Base base = read_base(attributes, context);
  // Sheen and coat lie on the outside of a volume.
  if (context.front || !is_volume_boundary()) {
    const Sheen sheen = read_sheen(attributes);
    const Clearcoat coat = read_coat(attributes, context);
    if (sheen || coat) return Layered(mixture(base, context), sheen, coat);
  }
  if (base.metallic >= 1) return Glossy::conductor(base.metal, base.ggx);
  if (base.transmission >= 1 && base.metallic <= 0) return glass(base, context);
  if (base.transmission > 0) return mixture(base, context);
  const bool matte = base.dielectric.f90 <= 0 && !base.dielectric.film && is_black(base.body.transmitted);
  if (matte && base.metallic <= 0) {
    if (base.body.is_rough()) return RoughDiffuse{base.body.reflected, Eon(base.body.roughness)};
    return Lambert{base.body.reflected};
  }
  return glossy(base, base.metallic, context);
}

Material::Base Material::read_base(const SurfaceAttributes& attributes, const BsdfContext& context) const {
  const auto& d = description_;
  Base base;
  base.color = rgb(base_color(attributes));
  base.metallic = d.metallic;
  float roughness = d.roughness;
  if (d.metallic_roughness_texture) {
    const Vec4f texel = read(d.metallic_roughness_texture, attributes, TexelEncoding::linear);
    roughness *= texel.y;
    base.metallic *= texel.z;
  }
  const float alpha = square(std::clamp(roughness, 0.f, 1.f));
  base.ggx = {alpha, alpha};
  if (is_anisotropic()) {
    const float strength = d.anisotropy * read(d.anisotropy_texture, attributes, TexelEncoding::linear).z;
    if (strength > 0) base.ggx = {lerp(square(strength), alpha, 1.f), std::max(alpha, Ggx::smooth_limit)};
  }
  base.metal = {base.color, 1, read_film(attributes)};
  base.body.reflected = base.color;
  if (d.diffuse_roughness > 0)
    base.body.roughness =
        d.diffuse_roughness * read(d.diffuse_roughness_texture, attributes, TexelEncoding::linear).x;
  if (base.metallic < 1) read_dielectric(attributes, context, base);
  return base;
}

void Material::read_dielectric(const SurfaceAttributes& attributes, const BsdfContext& context,
                               Base& base) const {
  const auto& d = description_;
  // KHR_materials_specular on top of KHR_materials_ior; an index of 0 asks for full reflectance.
  const float f90 = d.specular * read(d.specular_texture, attributes, TexelEncoding::linear).w;
  const Rgb color = d.specular_color * read_color(d.specular_color_texture, attributes);
  const float f0 = d.ior == 0 ? 1 : f0_from_ior(d.ior / context.outside_ior[1]);
  base.dielectric = {color, f90, base.metal.film};
  for (int c = 0; c < 3; ++c) base.dielectric.f0[c] = std::min(f0 * color[c], 1.f) * f90;

  base.transmission = d.transmission * read(d.transmission_texture, attributes, TexelEncoding::linear).x;
  const float weight =
      d.diffuse_transmission * read(d.diffuse_transmission_texture, attributes, TexelEncoding::linear).w;
  if (weight <= 0) return;
  base.body.reflected = base.color * (1 - weight);
  base.body.transmitted =
      d.diffuse_transmission_color * weight * read_color(d.diffuse_transmission_color_texture, attributes);
}

ThinFilm Material::read_film(const SurfaceAttributes& attributes) const {
  const auto& d = description_;
  if (d.iridescence <= 0) return {};
  const float strength = d.iridescence * read(d.iridescence_texture, attributes, TexelEncoding::linear).x;
  const float blend = read(d.iridescence_thickness_texture, attributes, TexelEncoding::linear).y;
  const float thickness = lerp(blend, d.iridescence_thickness_min, d.iridescence_thickness_max);
  if (thickness <= 0) return {};
  return {strength, d.iridescence_ior, thickness};
}

Sheen Material::read_sheen(const SurfaceAttributes& attributes) const {
  const auto& d = description_;
  if (is_black(d.sheen_color)) return {};
  const Rgb color = d.sheen_color * read_color(d.sheen_color_texture, attributes);
  return {color, d.sheen_roughness * read(d.sheen_roughness_texture, attributes, TexelEncoding::linear).w};
}

float Material::coat_weight(const SurfaceAttributes& attributes) const {
  if (!has_coat()) return 0;
  return description_.clearcoat * read(description_.clearcoat_texture, attributes, TexelEncoding::linear).x;
}

Clearcoat Material::read_coat(const SurfaceAttributes& attributes, const BsdfContext& context) const {
  const auto& d = description_;
  const float weight = coat_weight(attributes);
  if (weight <= 0) return {};
  const float roughness =
      d.clearcoat_roughness * read(d.clearcoat_roughness_texture, attributes, TexelEncoding::linear).y;
  return {weight, square(roughness), context.coat_normal};
}

Glossy Material::glossy(const Base& base, float metallic, const BsdfContext& context) const {
  if (metallic >= 1) return Glossy::conductor(base.metal, base.ggx);
  DiffuseBase body = base.body;
  if (description_.transmission > 0 && is_volume_boundary()) body.eta = side(context).eta;
  const Glossy plastic = Glossy::coated_diffuse(base.dielectric, base.ggx, body);
  return metallic > 0 ? Glossy::mix(plastic, Glossy::conductor(base.metal, base.ggx), metallic) : plastic;
}

Dielectric Material::glass(const Base& base, const BsdfContext& context) const {
  const Side side = this->side(context);
  const Dielectric result{side.eta,    base.ggx,       base.color, base.dielectric, !is_volume_boundary(),
                          side.energy, side.dispersion};
  return context.channel && side.dispersion ? result.of_channel(*context.channel) : result;
}

Mixture Material::mixture(const Base& base, const BsdfContext& context) const {
  const float clear = (1 - base.metallic) * base.transmission;
  if (clear <= 0) return {glossy(base, base.metallic, context), 0, {}};
  const float metallic = clear < 1 ? base.metallic / (1 - clear) : 0;
  return {glossy(base, metallic, context), clear, glass(base, context)};
}

Rgb Material::emission(const SurfaceAttributes& attributes, bool front, float cos_theta) const {
  const auto& d = description_;
  if (!front && !d.double_sided) return {0, 0, 0};
  if (d.unlit) return rgb(base_color(attributes));
  Rgb radiance = d.emissive;
  if (d.emissive_texture) radiance *= read_color(d.emissive_texture, attributes);
  if (has_coat()) radiance *= 1 - Clearcoat{coat_weight(attributes)}.reflectance(std::abs(cos_theta));
  return radiance;
}

}  // namespace vernier
