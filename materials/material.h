// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "materials/bsdf.h"
#include "materials/color_mips.h"
#include "vernier/material.h"
#include "vernier/scene.h"
#include "vernier/texture.h"

namespace vernier {

/// What a mesh says at a point, interpolated: what materials read textures and vertex colours with.
struct SurfaceAttributes {
  std::array<Vec2f, 2> uv{Vec2f(0, 0), Vec2f(0, 0)};
  Vec4f color{1, 1, 1, 1};
  /// Where further sets of texture coordinates are found; null: there are none.
  const MeshDescription* mesh = nullptr;
  uint32_t triangle = 0;
  Vec2f barycentrics{0, 0};

  /// What of the triangle the point stands for where textures of colors are averaged: sides of a
  /// parallelogram in barycentrics, with `mesh` to find texture coordinates in.
  bool has_footprint = false;
  std::array<Vec2f, 2> footprint{Vec2f(0, 0), Vec2f(0, 0)};

  Vec2f texcoord(int set) const { return set < 2 ? uv[size_t(set)] : further_texcoord(set); }
  /// The footprint in texture coordinates.
  UvArea texcoord_area(int set) const;

 private:
  Vec2f further_texcoord(int set) const;
};

/// How light meets a surface, as far as its scattering depends on it.
struct BsdfContext {
  bool front = true;             ///< front faces look to the outside of a volume
  Rgb outside_ior{1, 1, 1};      ///< index of refraction, by channel, of what fills the space on the front
  Vec3f coat_normal{0, 0, 1};    ///< of a clear coat, in the frame that the BSDF is to be used in
  std::optional<int> channel{};  ///< the one colour channel that the path still carries, if only one
};

/// A glTF material compiled to the least model that is exact for it, with its textures at hand. What it does
/// not use is not read: ask needs_attributes() and needs_tangents() before interpolating them. Refers to the
/// textures it was compiled with.
class Material {
 public:
  /// `has_colors`: the mesh has vertex colours, which multiply the base colour. `mips`: of the same textures,
  /// for attributes with a footprint; null: all are read at points.
  Material(const MaterialDescription& description, std::span<const Texture> textures, bool has_colors,
           const ColorMips* mips = nullptr);

  /// The scattering at a point.
  Bsdf bsdf(const SurfaceAttributes& attributes, const BsdfContext& context) const;

  /// Radiance emitted at a point on the side given; glTF emits from back faces of double-sided materials
  /// only. A clear coat darkens it by what it reflects; cos_theta: between its normal and the viewer.
  Rgb emission(const SurfaceAttributes& attributes, bool front, float cos_theta) const;

  /// Coverage in [0,1]: what part of light meets the surface at all (glTF alphaMode; 1 or 0 for MASK).
  float coverage(const SurfaceAttributes& attributes) const;

  /// Shading normal in tangent space from the normal texture, unit, z > 0; +z where there is none.
  Vec3f tangent_space_normal(const SurfaceAttributes& attributes) const;
  /// The same for a clear coat, which does not follow the base's normal texture.
  Vec3f tangent_space_coat_normal(const SurfaceAttributes& attributes) const;
  /// Direction in tangent space, unit, in which highlights are stretched; only if is_anisotropic().
  Vec2f anisotropy_direction(const SurfaceAttributes& attributes) const;

  /// A texture whose colors are averaged over footprints, those of cut surfaces by how much there is of them.
  /// All else shapes lobes, of which the mean is none of the same shape, or is coverage, whose mean would
  /// make cut surfaces thinner: it is read at points.
  struct ColorTexture {
    int index;
    bool by_alpha;
  };
  std::vector<ColorTexture> color_textures() const;

  bool needs_attributes() const { return needs_attributes_; }
  /// Something is told in tangent space: normals or the direction of anisotropy.
  bool needs_tangents() const { return has_normal_maps() || is_anisotropic(); }
  /// Texture coordinate set that the tangent space follows.
  int tangent_texcoord() const { return tangent_texcoord_; }
  bool has_normal_maps() const {
    return description_.normal_texture || (has_coat() && description_.clearcoat_normal_texture);
  }
  bool is_anisotropic() const { return description_.anisotropy > 0; }
  /// Has lobes beside its base's, which differ with the side that they are seen from.
  bool is_layered() const { return has_coat() || !is_black(description_.sheen_color); }
  /// Some of its lobes may be so sharp that no light is scattered by them but along one direction.
  bool may_be_sharp() const;
  bool has_coat() const { return description_.clearcoat > 0; }

  bool is_emissive() const { return is_emissive_; }
  /// The emission is the same at every point and to every direction of a side, and so is the coverage.
  bool emits_evenly() const {
    const bool covers_evenly = is_opaque() || !(has_colors_ || description_.base_color_texture);
    return !description_.unlit && !description_.emissive_texture && !has_coat() && covers_evenly;
  }
  /// About how many texels of the textures that emission and coverage depend on lie within a triangle with
  /// these corners; 0: no texture.
  float emissive_texels(const std::array<SurfaceAttributes, 3>& corners) const;
  /// Emits, but is no light: seen by rays that happen to meet it (KHR_materials_unlit).
  bool catches_shadow() const { return description_.catches_shadow; }
  bool is_unlit() const { return description_.unlit; }
  bool is_opaque() const { return description_.alpha_mode == AlphaMode::opaque; }
  bool double_sided() const { return description_.double_sided; }
  /// Whether the camera sees that side; light meets both.
  bool is_seen(bool front) const {
    return !description_.hidden_from_camera && (front || description_.double_sided);
  }
  /// Light may pass through the surface.
  bool transmits() const { return description_.transmits(); }
  /// Encloses a volume: its inside may absorb and scatter, and its surface bends light that passes it.
  bool is_volume_boundary() const { return description_.bounds_volume(); }
  /// Of what fills that volume, per metre: what is lost along a ray, by absorption and by scattering
  /// (KHR_materials_volume: -ln(colour) / distance), and what of it is scattered.
  const Rgb& extinction() const { return extinction_; }
  Rgb scattering() const { return extinction_ * description_.scattering_albedo; }
  float scattering_anisotropy() const { return description_.scattering_anisotropy; }
  /// Of a boundary, that some light passes it without being scattered, bent or not.
  bool passes_unscattered() const { return description_.transmission > 0; }
  /// Index of refraction of what lies behind the surface, by channel; air where light is not refracted.
  Rgb interior_ior() const;
  /// Some light may pass a surface that is no volume's boundary without being deflected.
  bool may_be_clear() const;
  const std::string& name() const { return description_.name; }

 private:
  /// The base layer at a point, textures read.
  struct Base {
    Rgb color{0, 0, 0};
    Ggx ggx;
    Fresnel metal, dielectric;
    DiffuseBase body;
    float metallic = 0, transmission = 0;
  };
  /// Relative indices of a volume's boundary from one side.
  struct Side {
    float eta = 1;
    const DielectricAlbedo* energy = nullptr;
    const Dispersion* dispersion = nullptr;
  };

  /// From `front` or back, with a medium of these indices on the front.
  Side make_side(bool front, const Rgb& outside_ior) const;

  Vec4f read(const TextureUse& use, const SurfaceAttributes& attributes, TexelEncoding encoding) const;
  /// Of sRGB colors, over the footprint where there is one.
  Rgb read_color(const TextureUse& use, const SurfaceAttributes& attributes) const;
  Rgb read_area(const TextureUse& use, const SurfaceAttributes& attributes, bool by_alpha) const;
  Vec4f base_color(const SurfaceAttributes& attributes) const;
  Vec3f read_normal(const TextureUse& use, float scale, const SurfaceAttributes& attributes) const;

  Bsdf make_bsdf(const SurfaceAttributes& attributes, const BsdfContext& context) const;
  Base read_base(const SurfaceAttributes& attributes, const BsdfContext& context) const;
  void read_dielectric(const SurfaceAttributes& attributes, const BsdfContext& context, Base& base) const;
  ThinFilm read_film(const SurfaceAttributes& attributes) const;
  Sheen read_sheen(const SurfaceAttributes& attributes) const;
  float coat_weight(const SurfaceAttributes& attributes) const;
  Clearcoat read_coat(const SurfaceAttributes& attributes, const BsdfContext& context) const;
  Glossy glossy(const Base& base, float metallic, const BsdfContext& context) const;
  Dielectric glass(const Base& base, const BsdfContext& context) const;
  Mixture mixture(const Base& base, const BsdfContext& context) const;
  Side side(const BsdfContext& context) const;

  MaterialDescription description_;
  std::span<const Texture> textures_;
  const ColorMips* mips_;
  bool has_colors_;
  bool needs_attributes_ = false;
  bool is_constant_ = false;  ///< nothing of the BSDF depends on the place
  bool is_emissive_ = false;
  int tangent_texcoord_ = 0;
  Rgb extinction_{0, 0, 0};
  std::array<Side, 2> sides_;  ///< back and front, in air; only of materials that transmit light unscattered
  Bsdf constant_front_, constant_back_;
};

}  // namespace vernier
