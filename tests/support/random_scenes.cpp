// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <span>

#include <nlohmann/json.hpp>

#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

class Maker {
 public:
  explicit Maker(uint64_t seed) : random_(seed), media_(~seed) {}

  RandomScene make() {
    texture();
    MaterialDescription ground = material(false);
    ground.transmission = ground.diffuse_transmission = 0;
    ground.alpha_mode = AlphaMode::opaque;
    add(parallelogram({-6, 0, -6}, {0, 0, 12}, {12, 0, 0}), ground);
    bodies();
    for (int sheets = int(between(0, 4)); sheets > 0; --sheets)
      add(sheet({between(-2, 2), between(0.2f, 3), between(-2, 1)}), material(false));
    lights();
    for (int i = 0; i < 2; ++i)
      result_.rays.push_back(ray_through({between(-3, 3), between(0.5f, 4), between(1.5f, 5)},
                                         {between(-2, 1.5f), between(0, 1.2f), between(-1, 0.5f)}));
    result_.max_depth = 2 + int(between(0, 5));
    return std::move(result_);
  }

 private:
  float between(float low, float high) { return lerp(random_.next1(), low, high); }
  bool chance(float share) { return random_.next1() < share; }
  Rgb color(float low, float high) {
    Rgb c;
    for (int i = 0; i < 3; ++i) c[i] = between(low, high);
    return c;
  }

  void add(MeshDescription mesh, const MaterialDescription& material, const Transform& to_world = {}) {
    auto& d = result_.description;
    const auto index = uint32_t(d.meshes.size());
    d.meshes.push_back(std::move(mesh));
    d.materials.push_back(material);
    d.instances.push_back({fmt::format("thing {}", index), index, index, to_world, {}});
  }

  /// Beside, in, overlapping or touching the one before.
  void bodies() {
    Vec3f lower(-1.5f, 0.05f, -0.8f), upper = lower + size();
    bool is_against = false, may_touch = false;
    for (int count = 1 + int(between(0, 4)); count > 0; --count) {
      const bool round = chance(0.25f);
      const MaterialDescription m = material(true);
      // Which of two surfaces at one place is met is nobody's to say, but for boundaries of volumes.
      const bool is_filled = m.bounds_volume() && m.alpha_mode == AlphaMode::opaque && is_black(m.emissive);
      if (is_against && !(may_touch && is_filled)) lower.x += 0.01f, upper.x += 0.01f;
      is_against = false;
      may_touch = is_filled;
      add(round ? sphere((lower + upper) * 0.5f, min_half(upper - lower), 8, 16) : box(lower, upper), m);
      const Vec3f extent = upper - lower;
      if (const float how = random_.next1(); how < 0.25f) {  // within
        lower += extent * 0.2f;
        upper -= extent * 0.25f;
      } else if (how < 0.5f) {  // across
        lower += Vec3f(extent.x * 0.6f, extent.y * 0.1f, extent.z * 0.1f);
        upper = lower + size();
      } else if (how < 0.65f) {  // against
        is_against = true;
        lower.x = upper.x;
        upper = lower + size();
      } else {
        lower = {lower.x + 1.6f, 0.05f, between(-1, 0)};
        upper = lower + size();
      }
    }
    if (!chance(0.3f)) return;
    // Copies of the last thing, turned, shrunk and mirrored.
    auto& instances = result_.description.instances;
    for (int i = 0; i < 2; ++i) {
      InstanceDescription copy = instances.back();
      const float angle = between(0, 3), scale = between(0.4f, 0.9f);
      copy.to_world.x = Vec3f(std::cos(angle), 0, -std::sin(angle)) * scale;
      copy.to_world.y = Vec3f(0, chance(0.3f) ? -scale : scale, 0);
      copy.to_world.z = Vec3f(std::sin(angle), 0, std::cos(angle)) * scale;
      copy.to_world.origin = {between(-2, 2), between(1, 2), between(-2, 1)};
      instances.push_back(copy);
    }
  }

  Vec3f size() { return {between(0.4f, 1.2f), between(0.4f, 1.5f), between(0.4f, 1.2f)}; }
  static float min_half(const Vec3f& v) { return std::min(v.x, std::min(v.y, v.z)) / 2; }

  MeshDescription sheet(const Vec3f& corner) {
    return parallelogram(corner, {between(0.3f, 1.5f), between(-0.4f, 0.4f), between(-0.3f, 0.3f)},
                         {between(-0.3f, 0.3f), between(-0.4f, 0.4f), between(0.3f, 1.5f)});
  }

  /// Alpha in 4 x 4 squares.
  void texture() {
    auto image = std::make_shared<Image8>(4, 4, 4);
    for (size_t i = 0; i < image->values.size(); ++i)
      image->values[i] = i % 4 == 3 ? uint8_t(between(0, 255.9f)) : 255;
    result_.description.textures.emplace_back(std::move(image), WrapMode::clamp_to_edge,
                                              WrapMode::clamp_to_edge, FilterMode::nearest);
  }

  MaterialDescription material(bool closed) {
    MaterialDescription m;
    const Rgb base = color(0.1f, 1);
    m.base_color = {base.x, base.y, base.z, 1};
    m.metallic = chance(0.5f) ? float(chance(0.5f)) : random_.next1();
    m.roughness = chance(0.3f) ? 0.f : between(0.15f, 1);
    m.double_sided = chance(0.5f);
    if (chance(0.45f)) transmission(m, closed);
    if (chance(0.2f)) {
      m.diffuse_transmission = random_.next1();
      m.diffuse_transmission_color = color(0, 1);
    }
    if (chance(0.2f)) {
      m.clearcoat = random_.next1();
      m.clearcoat_roughness = chance(0.4f) ? 0.f : between(0.2f, 1);
    }
    if (chance(0.2f)) {
      m.sheen_color = color(0, 1);
      m.sheen_roughness = between(0.2f, 1);
    }
    // A smooth one would be a lobe too narrow for samples of lights and too wide for a mirror.
    if (m.roughness > 0 && chance(0.2f)) m.anisotropy = random_.next1();
    if (chance(0.15f)) m.iridescence = random_.next1();
    if (chance(0.3f)) m.diffuse_roughness = random_.next1();
    if (chance(0.2f)) {
      m.specular = random_.next1();
      m.specular_color = color(0, 1.5f);
    }
    if (chance(0.25f)) m.emissive = color(0, 4);
    if (chance(0.25f)) {
      m.alpha_mode = chance(0.5f) ? AlphaMode::mask : AlphaMode::blend;
      m.base_color.w = chance(0.5f) ? 1 : random_.next1();
      if (!closed && chance(0.7f)) m.base_color_texture.texture = 0;
    }
    return m;
  }

  /// Thin-walled, filled, or a sheet that asks in vain to be filled.
  void transmission(MaterialDescription& m, bool closed) {
    if (chance(0.6f)) m.metallic = 0;
    m.transmission = chance(0.6f) ? 1 : random_.next1();
    m.ior = chance(0.3f) ? 1 : chance(0.3f) ? 1.4f : between(1.05f, 2);
    if (!chance(closed ? 0.7f : 0.2f)) return;
    m.thickness = 1;
    m.attenuation_distance = between(0.2f, 2);
    m.attenuation_color = color(0.2f, 1);
    if (chance(0.2f)) m.dispersion = between(0, 5);
    if (media_.next1() < 0.7f) return;
    for (int c = 0; c < 3; ++c) m.scattering_albedo[c] = lerp(media_.next1(), 0.3f, 1);
    m.scattering_anisotropy = media_.next1() < 0.3f ? 0 : lerp(media_.next1(), -0.6f, 0.8f);
  }

  void lights() {
    auto& d = result_.description;
    MaterialDescription panel = emitter(1);
    panel.emissive = color(1, 6);
    panel.double_sided = chance(0.5f);
    add(parallelogram({between(-1, 1), 3.2f, between(-1, 1)}, {1, 0, between(-0.3f, 0.3f)},
                      {0, between(-0.3f, 0.3f), 1}),
        panel);
    if (chance(0.6f)) {
      auto picture = std::make_shared<Image>(32, 16, 3);
      for (float& value : picture->values) value = chance(0.02f) ? between(0, 30) : random_.next1();
      auto sky = std::make_shared<EnvironmentDescription>();
      sky->picture = std::move(picture);
      sky->rotation = between(0, 6);
      d.environment = std::move(sky);
    }
    if (!chance(0.4f)) return;
    result_.has_lamps = true;
    for (int count = 1 + int(between(0, 5)); count > 0; --count) {
      PunctualLightDescription lamp;
      lamp.kind = PunctualLightDescription::Kind(int(between(0, 2.99f)));
      lamp.intensity = between(1, 5);
      lamp.outer_cone = between(0.2f, 1.5f);
      lamp.to_world.origin = {between(-2, 2), between(1.5f, 3), between(-1, 2)};
      lamp.to_world.z =
          normalize(Vec3f(between(-0.5f, 0.5f), chance(0.7f) ? 1.f : -1.f, between(-0.5f, 0.5f)));
      d.lights.push_back(lamp);
    }
  }

  Random random_, media_;
  RandomScene result_;
};

using nlohmann::json;

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : letters[word >> (18 - 6 * k) & 63];
  }
  return text;
}

json matrix(const Transform& t) {
  return {t.x.x, t.x.y, t.x.z, 0, t.y.x,      t.y.y,      t.y.z,      0,
          t.z.x, t.z.y, t.z.z, 0, t.origin.x, t.origin.y, t.origin.z, 1};
}

json array_of(const Rgb& c) { return {c.x, c.y, c.z}; }

/// What KHR_materials_volume_scatter calls a medium of that single-scattering albedo: its formula solved for
/// the color, whose square terms cancel.
float multiscatter_color(float albedo) {
  const float k = 4.09712f - std::sqrt(1 - albedo);
  return std::clamp((9.59217f - k * k) / (8.41726f * k - 41.6808f), 0.f, 1.f);
}

json material_json(const MaterialDescription& m) {
  json j{{"doubleSided", m.double_sided},
         {"alphaMode", m.alpha_mode == AlphaMode::opaque ? "OPAQUE"
                       : m.alpha_mode == AlphaMode::mask ? "MASK"
                                                         : "BLEND"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {m.base_color.x, m.base_color.y, m.base_color.z, m.base_color.w}},
           {"metallicFactor", m.metallic},
           {"roughnessFactor", m.roughness}}}};
  json& extensions = j["extensions"] = json::object();
  const float strength = std::max(1.f, max_component(m.emissive));
  j["emissiveFactor"] = array_of(m.emissive / strength);
  extensions["KHR_materials_emissive_strength"]["emissiveStrength"] = strength;
  extensions["KHR_materials_ior"]["ior"] = m.ior;
  extensions["KHR_materials_specular"] = {{"specularFactor", m.specular},
                                          {"specularColorFactor", array_of(m.specular_color)}};
  if (m.transmission > 0) extensions["KHR_materials_transmission"]["transmissionFactor"] = m.transmission;
  if (m.thickness > 0) {
    auto& volume = extensions["KHR_materials_volume"] = {{"thicknessFactor", m.thickness},
                                                         {"attenuationColor", array_of(m.attenuation_color)}};
    // Infinity is the default, and no number of JSON.
    if (std::isfinite(m.attenuation_distance)) volume["attenuationDistance"] = m.attenuation_distance;
  }
  if (const Rgb& albedo = m.scattering_albedo; !is_black(albedo))
    extensions["KHR_materials_volume_scatter"] = {
        {"multiscatterColor",
         {multiscatter_color(albedo.x), multiscatter_color(albedo.y), multiscatter_color(albedo.z)}},
        {"scatterAnisotropy", m.scattering_anisotropy}};
  if (m.diffuse_transmission > 0)
    extensions["KHR_materials_diffuse_transmission"] = {
        {"diffuseTransmissionFactor", m.diffuse_transmission},
        {"diffuseTransmissionColorFactor", array_of(m.diffuse_transmission_color)}};
  if (m.clearcoat > 0)
    extensions["KHR_materials_clearcoat"] = {{"clearcoatFactor", m.clearcoat},
                                             {"clearcoatRoughnessFactor", m.clearcoat_roughness}};
  if (!is_black(m.sheen_color))
    extensions["KHR_materials_sheen"] = {{"sheenColorFactor", array_of(m.sheen_color)},
                                         {"sheenRoughnessFactor", m.sheen_roughness}};
  if (m.anisotropy > 0) extensions["KHR_materials_anisotropy"]["anisotropyStrength"] = m.anisotropy;
  if (m.iridescence > 0) extensions["KHR_materials_iridescence"]["iridescenceFactor"] = m.iridescence;
  if (m.diffuse_roughness > 0)
    extensions["KHR_materials_diffuse_roughness"]["diffuseRoughnessFactor"] = m.diffuse_roughness;
  if (m.dispersion > 0) extensions["KHR_materials_dispersion"]["dispersion"] = m.dispersion;
  return j;
}

/// Arrays of a mesh at the end of one buffer, and how the file speaks of them.
class MeshWriter {
 public:
  json mesh(const MeshDescription& mesh, size_t material) {
    Bounds box;
    for (const Vec3f& p : mesh.positions) box.add(p);
    const size_t positions = accessor(mesh.positions, 5126, "VEC3", mesh.positions.size());
    accessors_.back()["min"] = {box.lower.x, box.lower.y, box.lower.z};
    accessors_.back()["max"] = {box.upper.x, box.upper.y, box.upper.z};
    const size_t indices = accessor(mesh.triangles, 5125, "SCALAR", 3 * mesh.triangles.size());
    return {{"primitives",
             {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", material}}}}};
  }

  void finish(json& file) const {
    file["accessors"] = accessors_;
    file["bufferViews"] = views_;
    file["buffers"] = {
        {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
  }

 private:
  template <typename T>
  size_t accessor(const std::vector<T>& values, int component, const char* type, size_t count) {
    const auto data = std::as_bytes(std::span(values));
    views_.push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", data.size()}});
    for (const std::byte b : data) bytes_.push_back(uint8_t(b));
    accessors_.push_back(
        {{"bufferView", views_.size() - 1}, {"componentType", component}, {"type", type}, {"count", count}});
    return accessors_.size() - 1;
  }

  std::vector<uint8_t> bytes_;
  json views_ = json::array(), accessors_ = json::array();
};

json lamp_json(const PunctualLightDescription& lamp) {
  constexpr const char* kinds[] = {"point", "spot", "directional"};
  json j{{"type", kinds[int(lamp.kind)]}, {"intensity", lamp.intensity}, {"color", array_of(lamp.color)}};
  if (lamp.kind == PunctualLightDescription::Kind::spot) j["spot"]["outerConeAngle"] = lamp.outer_cone;
  return j;
}

}  // namespace

RandomScene random_scene(uint64_t seed) { return Maker(seed).make(); }

std::string to_gltf(const SceneDescription& d) {
  json file{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  MeshWriter writer;
  for (const auto& instance : d.instances) {
    file["meshes"].push_back(writer.mesh(d.meshes[instance.mesh], instance.material));
    file["nodes"].push_back({{"name", instance.name},
                             {"mesh", file["meshes"].size() - 1},
                             {"matrix", matrix(instance.to_world)}});
  }
  for (const auto& m : d.materials) file["materials"].push_back(material_json(m));
  for (const auto& lamp : d.lights) {
    auto& lights = file["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(lamp_json(lamp));
    const Vec3f back = normalize(lamp.to_world.z), side = Frame::from_normal(back).x;
    Transform at{side, cross(back, side), back, lamp.to_world.origin};
    file["nodes"].push_back(
        {{"matrix", matrix(at)}, {"extensions", {{"KHR_lights_punctual", {{"light", lights.size() - 1}}}}}});
  }
  for (size_t i = 0; i < file["nodes"].size(); ++i) file["scenes"][0]["nodes"].push_back(i);
  writer.finish(file);
  std::set<std::string> used;
  for (const auto& m : file["materials"])
    for (const auto& [name, value] : m["extensions"].items()) used.insert(name);
  if (!d.lights.empty()) used.insert("KHR_lights_punctual");
  file["extensionsUsed"] = used;
  return file.dump();
}

}  // namespace vernier::test
