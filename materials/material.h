#pragma once

#include <span>

#include "materials/bsdf.h"
#include "materials/material_description.h"
#include "materials/texture.h"

namespace vernier {

/// What a mesh says at a point, interpolated: what materials read textures and vertex colours with.
struct SurfaceAttributes {
  std::array<Vec2f, 2> uv{Vec2f(0, 0), Vec2f(0, 0)};
  Vec4f color{1, 1, 1, 1};
};

/// A glTF material compiled to the least model that is exact for it, with its textures at hand. What it does
/// not use is not read: ask needs_attributes() before interpolating them. Refers to the textures it was
/// compiled with.
class Material {
 public:
  /// `has_colors`: the mesh has vertex colours, which multiply the base colour.
  Material(const MaterialDescription& description, std::span<const Texture> textures, bool has_colors);

  /// The scattering at a point met from the front or the back; front faces look to the outside of a volume.
  Bsdf bsdf(const SurfaceAttributes& attributes, bool front) const;

  /// Radiance emitted at a point on the side given; glTF emits from back faces of double-sided materials
  /// only.
  Rgb emission(const SurfaceAttributes& attributes, bool front) const;

  /// Coverage in [0,1]: what part of light meets the surface at all (glTF alphaMode; 1 or 0 for MASK).
  float coverage(const SurfaceAttributes& attributes) const;

  /// Shading normal in tangent space from the normal texture, unit, z > 0; only when has_normal_map().
  Vec3f tangent_space_normal(const SurfaceAttributes& attributes) const;

  bool needs_attributes() const { return needs_attributes_; }
  bool has_normal_map() const { return bool(description_.normal_texture); }
  /// Texture coordinate set that the normal map, and so the tangent frame, follows.
  int normal_texcoord() const { return description_.normal_texture.texcoord; }
  bool is_emissive() const { return is_emissive_; }
  /// Emits, but is no light: seen by rays that happen to meet it (KHR_materials_unlit).
  bool is_unlit() const { return description_.unlit; }
  bool is_opaque() const { return description_.alpha_mode == AlphaMode::opaque; }
  bool double_sided() const { return description_.double_sided; }
  /// Light may pass through the surface.
  bool transmits() const { return description_.transmission > 0; }
  /// Encloses a volume: its surface bends light and the inside absorbs.
  bool is_volume_boundary() const { return description_.thickness > 0 && description_.transmission > 0; }
  /// Absorption coefficient of that volume, per metre (KHR_materials_volume: -ln(colour) / distance).
  const Rgb& absorption() const { return absorption_; }
  const std::string& name() const { return description_.name; }

 private:
  Vec4f read(const TextureUse& use, const SurfaceAttributes& attributes, TexelEncoding encoding) const;
  Vec4f base_color(const SurfaceAttributes& attributes) const;
  Bsdf make_bsdf(const SurfaceAttributes& attributes, bool front) const;

  MaterialDescription description_;
  std::span<const Texture> textures_;
  bool has_colors_;
  bool needs_attributes_ = false;
  bool is_constant_ = false;  ///< nothing of the BSDF depends on the place
  bool is_emissive_ = false;
  Rgb absorption_{0, 0, 0};
  const GlassEnergy* energy_front_ = nullptr;  ///< of a volume's boundary
  const GlassEnergy* energy_back_ = nullptr;
  Bsdf constant_front_, constant_back_;
};

}  // namespace vernier
