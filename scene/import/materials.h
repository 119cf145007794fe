// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "scene/import/document.h"
#include "scene/import/specular_glossiness.h"
#include "vernier/material.h"
#include "vernier/scene.h"

namespace vernier {

/// A material as the importer uses it on the way.
struct ImportedMaterial {
  MaterialDescription description;
  /// The file's TEXCOORD_n that are the sets of the description.
  std::vector<int> texcoord_sets{0, 1};
};

struct ImportedMaterials {
  std::vector<ImportedMaterial> materials;
  std::vector<RoughnessFromGlossiness> derived;  ///< textures that the file has in another form
};

/// All materials of the file, and after them glTF's default material. TextureUse::texture is the file's own
/// texture index or, beyond those, one of `derived`. Values outside their range are clamped, which is
/// noticed.
ImportedMaterials read_materials(const Document& document, std::vector<Notice>& notices);

/// Calls visit(TextureUse&) for each texture slot of a material (const or not).
template <typename Material, typename Visit>
void for_each_texture(Material& m, const Visit& visit) {
  for (auto* use :
       {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture, &m.emissive_texture,
        &m.specular_texture, &m.specular_color_texture, &m.transmission_texture, &m.clearcoat_texture,
        &m.clearcoat_roughness_texture, &m.clearcoat_normal_texture, &m.sheen_color_texture,
        &m.sheen_roughness_texture, &m.anisotropy_texture, &m.iridescence_texture,
        &m.iridescence_thickness_texture, &m.diffuse_transmission_texture,
        &m.diffuse_transmission_color_texture, &m.diffuse_roughness_texture})
    visit(*use);
}

/// How glTF reads red, green and blue in a slot of the material; empty where alpha alone is read.
inline std::optional<TexelEncoding> encoding_of(const MaterialDescription& m, const TextureUse& slot) {
  if (&slot == &m.specular_texture || &slot == &m.sheen_roughness_texture) return std::nullopt;
  for (const auto* color : {&m.base_color_texture, &m.emissive_texture, &m.specular_color_texture,
                            &m.sheen_color_texture, &m.diffuse_transmission_color_texture})
    if (&slot == color) return TexelEncoding::srgb;
  return TexelEncoding::linear;
}

}  // namespace vernier
