// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>

#include "vernier/math.h"

namespace vernier {

/// A texture as a material slot uses it: uv' = rotation(scale * uv) + offset (KHR_texture_transform).
struct TextureUse {
  int texture = -1;  ///< index into SceneDescription::textures; -1: none
  int texcoord = 0;  ///< of MeshDescription::texcoord_set
  Vec2f offset{0, 0}, scale{1, 1};
  float rotation = 0;  ///< radians, counter-clockwise as KHR_texture_transform defines it

  explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode { opaque, mask, blend };

/// A glTF 2.0 material as the file states it, with the specification's defaults. Factors are linear.
struct MaterialDescription {
  std::string name;
  bool hidden_from_camera = false;  ///< camera rays go on as if the surface were not there; light meets it

  Vec4f base_color{1, 1, 1, 1};
  TextureUse base_color_texture;  ///< RGB sRGB-encoded
  float metallic = 1, roughness = 1;
  TextureUse metallic_roughness_texture;  ///< G roughness, B metallic
  float diffuse_roughness = 0;            ///< KHR_materials_diffuse_roughness
  TextureUse diffuse_roughness_texture;   ///< R
  TextureUse normal_texture;
  float normal_scale = 1;

  Rgb emissive{0, 0, 0};        ///< emissiveFactor times KHR_materials_emissive_strength: radiance
  TextureUse emissive_texture;  ///< RGB sRGB-encoded

  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit
  /// Of level surfaces: where RenderSettings::background is not the surroundings, the camera sees the
  /// background through them, darkened by the part of the light from above that something keeps from
  /// them. To all other light they are what else they are.
  bool catches_shadow = false;

  float ior = 1.5f;             ///< KHR_materials_ior; 0 stands for an infinite index: Fresnel 1 everywhere
  float specular = 1;           ///< KHR_materials_specular
  TextureUse specular_texture;  ///< A
  Rgb specular_color{1, 1, 1};
  TextureUse specular_color_texture;  ///< RGB sRGB-encoded

  float transmission = 0;           ///< KHR_materials_transmission
  TextureUse transmission_texture;  ///< R
  float thickness = 0;              ///< KHR_materials_volume; 0: thin-walled
  float attenuation_distance = std::numeric_limits<float>::infinity();  ///< metres, world space
  Rgb attenuation_color{1, 1, 1};
  /// Part of what a volume takes from a ray that it scatters; the rest is absorbed (single-scattering
  /// albedo).
  Rgb scattering_albedo{0, 0, 0};
  float scattering_anisotropy = 0;  ///< mean cosine of its deflection, in (-1, 1) (Henyey and Greenstein)

  float clearcoat = 0;           ///< KHR_materials_clearcoat
  TextureUse clearcoat_texture;  ///< R
  float clearcoat_roughness = 0;
  TextureUse clearcoat_roughness_texture;  ///< G
  TextureUse clearcoat_normal_texture;
  float clearcoat_normal_scale = 1;

  Rgb sheen_color{0, 0, 0};        ///< KHR_materials_sheen
  TextureUse sheen_color_texture;  ///< RGB sRGB-encoded
  float sheen_roughness = 0;
  TextureUse sheen_roughness_texture;  ///< A

  float anisotropy = 0;           ///< KHR_materials_anisotropy: strength in [0, 1]
  float anisotropy_rotation = 0;  ///< radians, counter-clockwise from the tangent
  TextureUse anisotropy_texture;  ///< RG direction in [-1, 1] encoded as colour, B strength

  float iridescence = 0;           ///< KHR_materials_iridescence
  TextureUse iridescence_texture;  ///< R
  float iridescence_ior = 1.3f;
  float iridescence_thickness_min = 100, iridescence_thickness_max = 400;  ///< nanometres, at G = 0 and G = 1
  TextureUse iridescence_thickness_texture;  ///< G; none: the maximum everywhere

  float dispersion = 0;  ///< KHR_materials_dispersion: 20 / Abbe number

  float diffuse_transmission = 0;           ///< KHR_materials_diffuse_transmission
  TextureUse diffuse_transmission_texture;  ///< A
  Rgb diffuse_transmission_color{1, 1, 1};
  TextureUse diffuse_transmission_color_texture;  ///< RGB sRGB-encoded

  /// Light may pass through the surface.
  bool transmits() const { return transmission > 0 || diffuse_transmission > 0; }
  /// The surface encloses a volume (KHR_materials_volume).
  bool bounds_volume() const { return thickness > 0 && transmits(); }
};

}  // namespace vernier
