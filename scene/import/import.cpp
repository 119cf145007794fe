// SPDX-License-Identifier: Apache-2.0
#include "vernier/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/base/fingerprint.h"
#include "core/base/parallel.h"
#include "scene/import/animated_property.h"
#include "scene/import/cameras_lights.h"
#include "scene/import/features.h"
#include "scene/import/image_light.h"
#include "scene/import/instances.h"
#include "scene/import/materials.h"
#include "scene/import/meshes.h"
#include "scene/import/moments.h"
#include "scene/import/nodes.h"
#include "scene/import/textures.h"
#include "scene/import/thin_bodies.h"
#include "scene/scene_bytes.h"

namespace vernier {
namespace {

template <typename T>
void append(const std::vector<T>& more, std::vector<T>& list) {
  list.insert(list.end(), more.begin(), more.end());
}

/// Keeps the materials that instances use, in the file's order, and renumbers the instances.
void keep_used_materials(const std::vector<ImportedMaterial>& all, SceneDescription& scene) {
  std::vector<uint32_t> renumbered(all.size(), 0);
  for (const auto& instance : scene.instances) renumbered[instance.material] = 1;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!renumbered[i]) continue;
    renumbered[i] = uint32_t(scene.materials.size());
    scene.materials.push_back(all[i].description);
  }
  for (auto& instance : scene.instances) instance.material = renumbered[instance.material];
}

/// A texture that could not be read is magenta as a base colour. Elsewhere magenta would stand for a normal
/// or a roughness, so the slot keeps its factor alone, and a surface that glows by texture does not glow.
void leave_out_unreadable(MaterialDescription& material, const std::vector<bool>& unreadable) {
  const auto is_unreadable = [&](const TextureUse& use) { return use && unreadable[size_t(use.texture)]; };
  if (is_unreadable(material.emissive_texture)) material.emissive = Rgb(0, 0, 0);
  for_each_texture(material, [&](TextureUse& use) {
    if (&use != &material.base_color_texture && is_unreadable(use)) use = {};
  });
}

/// The textures that materials use, by their index.
std::vector<WantedTexture> used_textures(const std::vector<MaterialDescription>& materials) {
  std::map<int, WantedTexture> used;
  for (const auto& material : materials)
    for_each_texture(material, [&](const TextureUse& use) {
      if (!use) return;
      WantedTexture& wanted = used[use.texture];
      wanted.index = use.texture;
      const auto encoding = encoding_of(material, use);
      wanted.as_srgb |= encoding == TexelEncoding::srgb;
      wanted.as_linear |= encoding == TexelEncoding::linear;
    });
  std::vector<WantedTexture> list;
  list.reserve(used.size());
  for (const auto& [index, wanted] : used) list.push_back(wanted);
  return list;
}

/// Decodes the textures that the scene's materials use and renumbers their uses.
void add_textures(const Document& document, const std::vector<RoughnessFromGlossiness>& derived,
                  ImageCache& images, SceneDescription& scene, std::vector<std::string>& fingerprints) {
  const std::vector<WantedTexture> wanted = used_textures(scene.materials);
  std::map<int, int> places;
  for (const WantedTexture& texture : wanted) places.emplace(texture.index, int(places.size()));

  DecodedTextures decoded = read_textures(document, wanted, derived, images, scene.notices);
  scene.textures = std::move(decoded.textures);
  append(decoded.fingerprints, fingerprints);
  for (auto& material : scene.materials) {
    for_each_texture(material, [&](TextureUse& use) {
      if (use) use.texture = places.at(use.texture);
    });
    leave_out_unreadable(material, decoded.unreadable);
  }
}

/// Leaves out, with a warning, what lies so far out that areas and volumes overflow single precision, which
/// bounding volume hierarchies compute in. `names`: of nodes that were left out before.
void leave_out_far(std::vector<std::string> names, SceneDescription& scene) {
  constexpr float farthest = 1e18f;
  std::vector<Vec3f> reach(scene.meshes.size(), Vec3f(0, 0, 0));
  parallel_for(reach.size(), [&](size_t i) {
    for (const Vec3f& p : scene.meshes[i].positions) reach[i] = max(reach[i], abs(p));
    for (const MeshShape& shape : scene.meshes[i].moments)
      for (const Vec3f& p : shape.positions) reach[i] = max(reach[i], abs(p));
  });
  const auto is_far = [&](const InstanceDescription& instance) {
    const Vec3f& own = reach[instance.mesh];
    Vec3f placed = instance.to_world.absolute_point(own, 1);
    for (const Transform& moment : instance.moments) placed = max(placed, moment.absolute_point(own, 1));
    return !(max_component(own) <= farthest && max_component(placed) <= farthest);
  };
  for (const auto& instance : scene.instances)
    if (is_far(instance)) names.push_back(instance.name);
  if (names.empty()) return;
  scene.instances.erase(std::remove_if(scene.instances.begin(), scene.instances.end(), is_far),
                        scene.instances.end());
  const std::string more = names.size() > 1 ? fmt::format(" and {} more", names.size() - 1) : "";
  scene.notices.push_back(
      {Notice::Severity::warning, "/nodes",
       fmt::format("the mesh of node '{}'{} reaches farther than {:g} m from the origin, which "
                   "is too large for single precision, and is left out; scale the scene down",
                   names[0], more, farthest)});
}

/// Throws Error(input) about the first thing that is not rendered exactly as the file says.
void check_strictly(const Document& document, const SceneDescription& scene) {
  for (const auto& feature : scene.features)
    if (feature.status != FeatureUse::Status::exact) document.fail("", "strict: " + describe(feature));
  refuse_warnings(scene.source, scene.notices);
}

std::string combined_fingerprint(const std::vector<std::string>& parts) {
  const std::string all = fmt::format("{}", fmt::join(parts, ""));
  return fingerprint({reinterpret_cast<const uint8_t*>(all.data()), all.size()});
}

}  // namespace

/// The file as far as it depends on neither time nor variant.
class SceneFile::Content {
 public:
  explicit Content(AssetFiles files)
      : document_(std::move(files)),
        features_(report_features(document_.model())),
        materials_(read_materials(document_, material_notices_)) {
    note_unknown_pointers(document_, features_);
  }

  const Document& document() const { return document_; }

  /// `keep`: whether more descriptions may follow, for which meshes are kept.
  SceneDescription describe(const ImportOptions& options, bool keep);

 private:
  void add_shapes(const ImportOptions& options, bool keep, SceneDescription& scene);
  /// Reads anew what animations change beyond nodes, if they do or did so.
  void set_properties(std::span<const PropertyValue> values);
  void add_environment(SceneDescription& scene, std::vector<std::string>& fingerprints);

  struct ImageLight {
    std::shared_ptr<const EnvironmentDescription> environment;
    std::vector<Notice> notices;
    std::vector<std::string> fingerprints;
  };

  Document document_;
  std::vector<FeatureUse> features_;
  std::vector<Notice> material_notices_;
  ImportedMaterials materials_;
  ImageCache images_;
  MeshCache meshes_;
  std::optional<ImageLight> image_light_;  ///< none: not read yet
  bool at_rest_ = true;                    ///< materials and lights are those of the file
};

SceneDescription SceneFile::Content::describe(const ImportOptions& options, bool keep) {
  SceneDescription scene;
  scene.source = document_.files().scene_path();
  scene.features = features_;
  scene.notices = document_.notices();
  append(feature_notices(features_), scene.notices);
  add_shapes(options, keep, scene);

  std::vector<std::string> fingerprints = document_.fingerprints();
  if (options.memory.bytes > 0) images_.memory.limit(options.memory, bytes_to_build(scene));
  add_textures(document_, materials_.derived, images_, scene, fingerprints);
  add_environment(scene, fingerprints);
  scene.hash = combined_fingerprint(fingerprints);
  if (!options.variant.empty()) scene.choices.emplace_back("variant", options.variant);
  if (!options.animation.empty()) scene.choices.emplace_back("animation", options.animation);
  if (options.time) scene.choices.emplace_back("at", fmt::format("{}", *options.time));
  if (options.shutter)
    scene.choices.emplace_back("shutter",
                               fmt::format("{},{}", options.shutter->open, options.shutter->close));

  note_bent_light(scene);
  if (options.strict) check_strictly(document_, scene);
  return scene;
}

void SceneFile::Content::add_shapes(const ImportOptions& options, bool keep, SceneDescription& scene) {
  std::vector<NodePose> poses = rest_pose(document_, scene.notices);
  std::vector<PropertyValue> values;
  const bool is_posed = options.time || !options.animation.empty();
  if (is_posed)
    pose_by_animations(document_, options.animation, posed_time(options), poses, values, scene.notices);
  set_properties(values);
  const NodePlaces places = place_nodes(document_, poses);
  add_cameras_and_lights(document_, places, scene);

  append(material_notices_, scene.notices);
  InstancePlacer placer(document_, materials_.materials, options.variant);
  placer.add_nodes(places, poses);
  Placement placement = placer.take();
  scene.instances = std::move(placement.instances);
  if (placement.empty)
    scene.notices.push_back(
        {Notice::Severity::warning, "/meshes",
         fmt::format("{} primitives have no positions, or too few for a line or triangle, and are left out",
                     placement.empty)});
  MeshRepairs repairs;
  scene.meshes =
      read_meshes(document_, placement.meshes, places.to_world, repairs, keep ? &meshes_ : nullptr);
  append(repairs.notices(), scene.notices);
  if (is_posed && options.shutter)
    add_moments({document_, materials_.materials, options, poses, values, places, placement.meshes, scene});
  leave_out_far(std::move(placement.too_far), scene);
  add_thin_bodies(document_, placement.meshes, scene);

  std::vector<ImportedMaterial> materials = materials_.materials;
  append(placement.thin_materials, materials);
  keep_used_materials(materials, scene);
}

void SceneFile::Content::set_properties(std::span<const PropertyValue> values) {
  if (values.empty() && at_rest_) return;
  at_rest_ = values.empty();
  document_.set_properties(values);
  material_notices_.clear();
  materials_ = read_materials(document_, material_notices_);
  images_.roughness.clear();
  image_light_.reset();
}

void SceneFile::Content::add_environment(SceneDescription& scene, std::vector<std::string>& fingerprints) {
  if (!image_light_) {
    ImageLight light;
    light.environment = read_image_light(document_, light.notices, light.fingerprints);
    image_light_ = std::move(light);
  }
  scene.environment = image_light_->environment;
  append(image_light_->notices, scene.notices);
  append(image_light_->fingerprints, fingerprints);
}

SceneFile::SceneFile(const std::string& path, bool allow_outside_files)
    : content_(std::make_unique<Content>(AssetFiles(path, allow_outside_files))) {}
SceneFile::SceneFile(const std::string& name, std::span<const uint8_t> bytes)
    : content_(std::make_unique<Content>(AssetFiles(name, bytes))) {}
SceneFile::~SceneFile() = default;

SceneDescription SceneFile::describe(const ImportOptions& options) {
  return content_->describe(options, true);
}

std::vector<std::string> SceneFile::variants() const { return variant_names(content_->document()); }

std::vector<AnimationSpan> SceneFile::animations() const {
  const tinygltf::Model& model = content_->document().model();
  std::vector<AnimationSpan> spans;
  for (const auto& animation : model.animations) {
    AnimationSpan& span = spans.emplace_back(AnimationSpan{animation.name});
    for (const auto& sampler : animation.samplers) {
      try {
        span.seconds = std::max(span.seconds, latest_key(content_->document(), sampler));
      } catch (const Error&) {
        // What is wrong with it is said when it is asked for.
      }
    }
  }
  return spans;
}

SceneDescription import_scene(const std::string& path, const ImportOptions& options) {
  return SceneFile::Content(AssetFiles(path, options.allow_outside_files)).describe(options, false);
}

void refuse_warnings(const std::string& path, std::span<const Notice> notices) {
  for (const Notice& notice : notices)
    if (notice.severity == Notice::Severity::warning)
      throw Error(ErrorKind::input, path, notice.place, "strict: " + notice.text);
}

}  // namespace vernier
