// SPDX-License-Identifier: Apache-2.0
#include "scene/import/materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/import/texcoord_sets.h"

namespace vernier {
namespace {

using tinygltf::Value;

/// The members of a JSON object that tinygltf keeps as it is; a missing object has none. Types are those of
/// the schema already.
class Members {
 public:
  explicit Members(const Value* object) : object_(object) {}
  Members(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto found = extensions.find(name);
    if (found != extensions.end()) object_ = &found->second;
  }

  bool exist() const { return object_ != nullptr; }
  const Value* find(const std::string& name) const {
    return object_ && object_->Has(name) ? &object_->Get(name) : nullptr;
  }
  float number(const std::string& name, float otherwise) const {
    const Value* value = find(name);
    return value ? float(value->GetNumberAsDouble()) : otherwise;
  }
  /// Not by way of a float, which has no largest int.
  int integer(const std::string& name, int otherwise) const {
    const Value* value = find(name);
    return value ? int(value->GetNumberAsDouble()) : otherwise;
  }
  Vec2f pair(const std::string& name, const Vec2f& otherwise) const {
    const Value* value = find(name);
    return value ? Vec2f(component(*value, 0), component(*value, 1)) : otherwise;
  }
  float component(const std::string& name, size_t i, float otherwise) const {
    const Value* value = find(name);
    return value ? component(*value, i) : otherwise;
  }
  Rgb color(const std::string& name, const Rgb& otherwise) const {
    const Value* value = find(name);
    return value ? Rgb(component(*value, 0), component(*value, 1), component(*value, 2)) : otherwise;
  }

 private:
  static float component(const Value& value, size_t i) { return float(value.Get(i).GetNumberAsDouble()); }

  const Value* object_ = nullptr;
};

bool is_true(const tinygltf::Value& object, const char* member) {
  return object.IsObject() && object.Has(member) && object.Get(member).IsBool() &&
         object.Get(member).Get<bool>();
}

/// Albedo of a single scattering in a medium of which a thick body reflects `multiple` (Kulla and Conty 2017,
/// "Revisiting Physically Based Shading at Imageworks", as KHR_materials_volume_scatter and, with the mean
/// cosine g, KHR_materials_scatter have it).
float single_scattering_albedo(float multiple, float g) {
  const float root = std::sqrt(9.59217f + 41.6808f * multiple + 17.7126f * square(multiple));
  const float s2 = square(4.09712f + 4.20863f * multiple - root);
  return std::clamp((1 - s2) / (1 - g * s2), 0.f, 1.f);
}

class MaterialReader {
 public:
  MaterialReader(const Document& document, size_t index, std::vector<RoughnessFromGlossiness>& derived,
                 std::vector<Notice>& notices)
      : source_(document.model().materials[index]),
        place_(fmt::format("/materials/{}", index)),
        texture_count_(int(document.model().textures.size())),
        derived_(derived),
        notices_(notices) {}

  ImportedMaterial read() {
    result_.name = source_.name;
    read_surface();
    if (const Members old = extension("KHR_materials_pbrSpecularGlossiness"); old.exist()) {
      read_specular_glossiness(old);
    } else {
      read_metallic_roughness();
      read_diffuse_roughness();
      read_specular();
    }
    read_emission();
    read_volume();
    read_coats();
    read_films();
    std::vector<int> sets = assign_texcoord_sets(result_);
    return {std::move(result_), std::move(sets)};
  }

 private:
  void read_surface() {
    result_.normal_texture = use_of(source_.normalTexture);
    result_.normal_scale = float(source_.normalTexture.scale);
    result_.double_sided = source_.doubleSided;
    result_.alpha_cutoff = float(source_.alphaCutoff);
    if (source_.alphaMode == "MASK") result_.alpha_mode = AlphaMode::mask;
    if (source_.alphaMode == "BLEND") result_.alpha_mode = AlphaMode::blend;
    result_.unlit = source_.extensions.count("KHR_materials_unlit") > 0;
    if (const auto& extras = source_.extras; extras.IsObject() && extras.Has("vernier"))
      result_.hidden_from_camera = is_true(extras.Get("vernier"), "hiddenFromCamera");
  }

  void read_metallic_roughness() {
    const auto& pbr = source_.pbrMetallicRoughness;
    for (int i = 0; i < 4; ++i)
      result_.base_color[i] = unit(float(pbr.baseColorFactor[size_t(i)]), "baseColorFactor");
    result_.metallic = unit(float(pbr.metallicFactor), "metallicFactor");
    result_.roughness = unit(float(pbr.roughnessFactor), "roughnessFactor");
    result_.base_color_texture = use_of(pbr.baseColorTexture);
    result_.metallic_roughness_texture = use_of(pbr.metallicRoughnessTexture);
  }

  void read_diffuse_roughness() {
    const Members diffuse = extension("KHR_materials_diffuse_roughness");
    result_.diffuse_roughness = unit(diffuse.number("diffuseRoughnessFactor", 0), "diffuseRoughnessFactor");
    result_.diffuse_roughness_texture = texture(diffuse, "diffuseRoughnessTexture");
  }

  /// As a dielectric whose Fresnel reflectance is the specular colour: an index of 0 makes it 1, which the
  /// colour then multiplies (KHR_materials_ior, "Interaction with other extensions").
  void read_specular_glossiness(const Members& old) {
    const Rgb diffuse = unit(old.color("diffuseFactor", Rgb(1, 1, 1)), "diffuseFactor");
    const float alpha = unit(old.component("diffuseFactor", 3, 1), "diffuseFactor");
    result_.base_color = Vec4f(diffuse.x, diffuse.y, diffuse.z, alpha);
    result_.base_color_texture = texture(old, "diffuseTexture");
    result_.metallic = 0;
    result_.ior = 0;
    result_.specular_color = unit(old.color("specularFactor", Rgb(1, 1, 1)), "specularFactor");
    const float glossiness = unit(old.number("glossinessFactor", 1), "glossinessFactor");
    result_.roughness = 1 - glossiness;
    result_.specular_color_texture = texture(old, "specularGlossinessTexture");
    if (!result_.specular_color_texture) return;
    const RoughnessFromGlossiness wanted{result_.specular_color_texture.texture, glossiness};
    const auto known = std::find(derived_.begin(), derived_.end(), wanted);
    result_.roughness = 1;
    result_.metallic_roughness_texture = result_.specular_color_texture;
    result_.metallic_roughness_texture.texture = texture_count_ + int(known - derived_.begin());
    if (known == derived_.end()) derived_.push_back(wanted);
  }

  void read_emission() {
    const float strength = extension("KHR_materials_emissive_strength").number("emissiveStrength", 1);
    const auto& factor = source_.emissiveFactor;
    for (int i = 0; i < 3; ++i)
      result_.emissive[i] = not_negative(float(factor[size_t(i)]) * strength, "emissiveFactor");
    result_.emissive_texture = use_of(source_.emissiveTexture);
  }

  void read_specular() {
    result_.ior = extension("KHR_materials_ior").number("ior", result_.ior);
    if (result_.ior != 0 && result_.ior < 1) {
      clamped("ior");
      result_.ior = 1;
    }
    const Members specular = extension("KHR_materials_specular");
    result_.specular = unit(specular.number("specularFactor", 1), "specularFactor");
    result_.specular_texture = texture(specular, "specularTexture");
    result_.specular_color =
        not_negative(specular.color("specularColorFactor", result_.specular_color), "specularColorFactor");
    result_.specular_color_texture = texture(specular, "specularColorTexture");
  }

  void read_volume() {
    const Members transmission = extension("KHR_materials_transmission");
    result_.transmission = unit(transmission.number("transmissionFactor", 0), "transmissionFactor");
    result_.transmission_texture = texture(transmission, "transmissionTexture");
    const Members volume = extension("KHR_materials_volume");
    result_.thickness = volume.number("thicknessFactor", 0);
    const float distance = volume.number("attenuationDistance", result_.attenuation_distance);
    if (distance > 0)
      result_.attenuation_distance = distance;
    else
      warn("an attenuationDistance of 0 or less is taken for none: the volume does not absorb");
    result_.attenuation_color =
        unit(volume.color("attenuationColor", result_.attenuation_color), "attenuationColor");
    read_scattering();
    result_.dispersion =
        not_negative(extension("KHR_materials_dispersion").number("dispersion", 0), "dispersion");
    const Members diffuse = extension("KHR_materials_diffuse_transmission");
    result_.diffuse_transmission =
        unit(diffuse.number("diffuseTransmissionFactor", 0), "diffuseTransmissionFactor");
    result_.diffuse_transmission_texture = texture(diffuse, "diffuseTransmissionTexture");
    result_.diffuse_transmission_color =
        unit(diffuse.color("diffuseTransmissionColorFactor", result_.diffuse_transmission_color),
             "diffuseTransmissionColorFactor");
    result_.diffuse_transmission_color_texture = texture(diffuse, "diffuseTransmissionColorTexture");
  }

  /// Two drafts of one thing, the later of which scales the color.
  void read_scattering() {
    const Members first = extension("KHR_materials_volume_scatter"),
                  later = extension("KHR_materials_scatter");
    if (!first.exist() && !later.exist()) return;
    const Members& scatter = later.exist() ? later : first;
    const char* color_name = later.exist() ? "multiscatterColorFactor" : "multiscatterColor";
    Rgb color = unit(scatter.color(color_name, Rgb(later.exist() ? 1.f : 0.f)), color_name);
    if (later.exist()) color *= unit(later.number("scatterStrengthFactor", 0), "scatterStrengthFactor");
    constexpr float most = 0.999f;
    const float anisotropy = scatter.number("scatterAnisotropy", 0);
    if (!(std::abs(anisotropy) <= most)) clamped("scatterAnisotropy");
    result_.scattering_anisotropy = std::clamp(anisotropy, -most, most);
    for (const char* slot : {"multiscatterColorTexture", "scatterStrengthTexture"})
      if (later.find(slot)) warn(fmt::format("{} is not used: a volume is the same all through", slot));
    if (is_black(color)) return;
    if (result_.thickness <= 0)
      return warn(
          "scattering is of volumes alone here, and the material is thin-walled (KHR_materials_volume)");
    if (!std::isfinite(result_.attenuation_distance) || result_.attenuation_color == Rgb(1, 1, 1))
      return warn("nothing is scattered: attenuationColor and attenuationDistance take nothing from light");
    for (int c = 0; c < 3; ++c)
      result_.scattering_albedo[c] =
          single_scattering_albedo(color[c], later.exist() ? result_.scattering_anisotropy : 0);
  }

  void read_coats() {
    const Members coat = extension("KHR_materials_clearcoat");
    result_.clearcoat = unit(coat.number("clearcoatFactor", 0), "clearcoatFactor");
    result_.clearcoat_texture = texture(coat, "clearcoatTexture");
    result_.clearcoat_roughness =
        unit(coat.number("clearcoatRoughnessFactor", 0), "clearcoatRoughnessFactor");
    result_.clearcoat_roughness_texture = texture(coat, "clearcoatRoughnessTexture");
    result_.clearcoat_normal_texture = texture(coat, "clearcoatNormalTexture");
    result_.clearcoat_normal_scale = Members(coat.find("clearcoatNormalTexture")).number("scale", 1);
    const Members sheen = extension("KHR_materials_sheen");
    result_.sheen_color = unit(sheen.color("sheenColorFactor", result_.sheen_color), "sheenColorFactor");
    result_.sheen_color_texture = texture(sheen, "sheenColorTexture");
    result_.sheen_roughness = unit(sheen.number("sheenRoughnessFactor", 0), "sheenRoughnessFactor");
    result_.sheen_roughness_texture = texture(sheen, "sheenRoughnessTexture");
  }

  void read_films() {
    const Members anisotropy = extension("KHR_materials_anisotropy");
    result_.anisotropy = unit(anisotropy.number("anisotropyStrength", 0), "anisotropyStrength");
    result_.anisotropy_rotation = anisotropy.number("anisotropyRotation", 0);
    result_.anisotropy_texture = texture(anisotropy, "anisotropyTexture");
    const Members film = extension("KHR_materials_iridescence");
    result_.iridescence = unit(film.number("iridescenceFactor", 0), "iridescenceFactor");
    result_.iridescence_texture = texture(film, "iridescenceTexture");
    result_.iridescence_ior = film.number("iridescenceIor", result_.iridescence_ior);
    if (result_.iridescence_ior < 1) {
      clamped("iridescenceIor");
      result_.iridescence_ior = 1;
    }
    result_.iridescence_thickness_min =
        not_negative(film.number("iridescenceThicknessMinimum", 100), "iridescenceThicknessMinimum");
    result_.iridescence_thickness_max =
        not_negative(film.number("iridescenceThicknessMaximum", 400), "iridescenceThicknessMaximum");
    result_.iridescence_thickness_texture = texture(film, "iridescenceThicknessTexture");
  }

  Members extension(const std::string& name) const { return {source_.extensions, name}; }

  template <typename TextureInfo>
  TextureUse use_of(const TextureInfo& info) {
    if (info.index < 0) return {};
    return transformed_use(info.index, info.texCoord, Members(info.extensions, "KHR_texture_transform"));
  }

  TextureUse texture(const Members& owner, const std::string& name) {
    const Members info(owner.find(name));
    if (!info.exist()) return {};
    const Members extensions(info.find("extensions"));
    return transformed_use(info.integer("index", -1), info.integer("texCoord", 0),
                           Members(extensions.find("KHR_texture_transform")));
  }

  TextureUse transformed_use(int texture, int texcoord, const Members& transform) {
    TextureUse use;
    use.texture = texture;
    use.texcoord = transform.integer("texCoord", texcoord);
    use.offset = transform.pair("offset", use.offset);
    use.scale = transform.pair("scale", use.scale);
    use.rotation = transform.number("rotation", 0);
    return use;
  }

  float unit(float value, const char* property) {
    if (!(value >= 0 && value <= 1)) clamped(property);
    return std::clamp(value, 0.f, 1.f);
  }
  float not_negative(float value, const char* property) {
    constexpr float largest = std::numeric_limits<float>::max();
    if (!(value >= 0 && value <= largest)) clamped(property);
    return std::clamp(value, 0.f, largest);
  }
  Rgb unit(const Rgb& c, const char* property) {
    return {unit(c.x, property), unit(c.y, property), unit(c.z, property)};
  }
  Rgb not_negative(const Rgb& c, const char* property) {
    return {not_negative(c.x, property), not_negative(c.y, property), not_negative(c.z, property)};
  }

  void clamped(const char* property) {
    warn(fmt::format("{} is outside its range and was clamped", property));
  }
  void warn(std::string text) { notices_.push_back({Notice::Severity::warning, place_, std::move(text)}); }

  const tinygltf::Material& source_;
  std::string place_;
  int texture_count_;
  std::vector<RoughnessFromGlossiness>& derived_;
  std::vector<Notice>& notices_;
  MaterialDescription result_;
};

}  // namespace

ImportedMaterials read_materials(const Document& document, std::vector<Notice>& notices) {
  ImportedMaterials result;
  for (size_t i = 0; i < document.model().materials.size(); ++i)
    result.materials.push_back(MaterialReader(document, i, result.derived, notices).read());
  result.materials.emplace_back();
  result.materials.back().description.name = "default";
  return result;
}

}  // namespace vernier
