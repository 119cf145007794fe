// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <random>

#include "scene/scene.h"
#include "tests/scene/compressed_grids.h"
#include "tests/support/effort.h"
#include "tests/support/ktx2_files.h"
#include "tests/support/png_bytes.h"

// Damaged scenes: files that use most of what the importer reads, changed at random. Whatever is done to
// them, they are either read into a scene that can be built and traced, or refused by one Error that names
// the file. VERNIER_MUTANTS=N makes N of each kind in place of the few here.

namespace vernier::test {
namespace {

using nlohmann::json;

/// Everything that a material may have beside the usual.
json all_layers(const json& texture) {
  return {{"KHR_materials_clearcoat", {{"clearcoatFactor", 1}, {"clearcoatTexture", texture}}},
          {"KHR_materials_transmission", {{"transmissionFactor", 0.5}, {"transmissionTexture", texture}}},
          {"KHR_materials_volume", {{"attenuationDistance", 2}, {"thicknessFactor", 1}}},
          {"KHR_materials_volume_scatter", {{"multiscatterColor", {0.5, 0.2, 0.1}}}},
          {"KHR_materials_scatter", {{"scatterMean", 0.3}}},
          {"KHR_materials_ior", {{"ior", 1.3}}},
          {"KHR_materials_dispersion", {{"dispersion", 1}}},
          {"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}},
          {"KHR_materials_specular", {{"specularFactor", 0.5}, {"specularColorTexture", texture}}},
          {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.5}, {"anisotropyTexture", texture}}},
          {"KHR_materials_diffuse_roughness", {{"diffuseRoughnessFactor", 0.5}}},
          {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.5}}},
          {"KHR_materials_iridescence", {{"iridescenceFactor", 1}, {"iridescenceTexture", texture}}},
          {"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}},
          {"KHR_xmp_json_ld", {{"packet", 0}}}};
}

/// What is set by pointers: of a node, a material, a texture's place, a lamp and a camera.
void add_pointers(GltfFile& file, int times) {
  const int ramp = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  json channels = json::array();
  for (const char* pointer :
       {"/nodes/1/extensions/KHR_node_visibility/visible",
        "/materials/0/pbrMetallicRoughness/roughnessFactor", "/materials/0/normalTexture/scale",
        "/extensions/KHR_lights_punctual/lights/0/intensity", "/cameras/0/perspective/yfov"}) {
    const json extension = {{"KHR_animation_pointer", {{"pointer", pointer}}}};
    channels.push_back({{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", extension}}}});
  }
  file.add("animations", {{"channels", channels}, {"samplers", {{{"input", times}, {"output", ramp}}}}});
}

/// Indexed, textured, skinned, morphed, animated, instanced, hidden, in variants; sparse data, volumes, an
/// archived material, lines and points, a data URI, cameras, lights and surroundings.
GltfFile everything() {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int normals = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int coordinates = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  const int colors =
      file.add_accessor(std::vector<uint8_t>{255, 0, 0, 255, 0, 9, 0, 255, 5, 5, 5, 99}, "VEC4", true);
  const int color_changes = file.add_accessor(std::vector<float>(9, 0.5f), "VEC3");
  const int joints = file.add_accessor(std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  const int weights = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0}, "VEC4");
  const int indices = file.add_accessor(std::vector<uint16_t>{0, 1, 2, 2, 1, 0}, "SCALAR");
  const int lift = file.add_accessor(std::vector<float>{0, 0, 2, 0, 0, 2, 0, 0, 2}, "VEC3");
  const int moved = file.add_view(std::vector<uint16_t>{1, 2});
  const int moved_to = file.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  file.json["accessors"][size_t(lift)]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", moved}, {"componentType", 5123}}},
      {"values", {{"bufferView", moved_to}}}};
  PngSource picture;
  picture.samples = {200, 100, 50};
  file.add("images", {{"bufferView", file.add_view(png_bytes(picture))}, {"mimeType", "image/png"}});
  file.add("samplers", {{"wrapS", 33071}, {"magFilter", 9728}});
  file.add("textures", {{"source", 0}, {"sampler", 0}});
  const json turned = {{"offset", {0.5, 0}}, {"rotation", 0.3}, {"scale", {2, 2}}};
  const json texture = {{"index", 0}, {"extensions", {{"KHR_texture_transform", turned}}}};
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", texture}, {"roughnessFactor", 0.4}}},
                         {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                         {"emissiveFactor", {1, 0.5, 0}},
                         {"alphaMode", "MASK"},
                         {"extensions", all_layers(texture)}});
  const json attributes = {{"POSITION", positions}, {"NORMAL", normals},  {"TEXCOORD_0", coordinates},
                           {"COLOR_0", colors},     {"JOINTS_0", joints}, {"WEIGHTS_0", weights}};
  file.add_mesh(attributes,
                {{"indices", indices},
                 {"material", 0},
                 {"targets", {{{"POSITION", lift}, {"COLOR_0", color_changes}}, {{"NORMAL", normals}}}}});
  file.json["meshes"][0]["weights"] = {0.5, 0.25};
  const int matrices = file.add_accessor(std::vector<float>(32, 0.25f), "MAT4");
  file.add("skins", {{"joints", {1, 2}}, {"inverseBindMatrices", matrices}});
  file.json["nodes"][0]["skin"] = 0;
  file.add_root({{"translation", {0, 0, 10}}, {"children", {2}}});
  file.add("nodes", {{"rotation", {0, 0, 0.6, 0.8}}, {"scale", {2, 2, 2}}});
  const int places = file.add_accessor(std::vector<float>{1, 0, 0, 0, 1, 0}, "VEC3");
  file.add_root({{"mesh", 0},
                 {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}}}});
  file.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  file.add_root({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1}}});
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"range", 9}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}}};
  file.add_root({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  const int times = file.add_accessor(std::vector<float>{0, 1}, "SCALAR");
  file.add("animations",
           {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}}}},
            {"samplers", {{{"input", times}, {"output", places}}}}});
  file.add("animations", {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "scale"}}}}}},
                          {"samplers", {{{"input", times}, {"output", places}}}}});
  file.add("images", {{"uri", "data:image/png;BASE64,iVBORw0KGgo%3D"}});
  file.add("textures", {{"source", 1}});
  const json old = {{"specularGlossinessTexture", {{"index", 0}, {"texCoord", 2}}},
                    {"diffuseTexture", {{"index", 1}}},
                    {"glossinessFactor", 0.5},
                    {"specularFactor", {0.1, 0.2, 0.3}}};
  file.add("materials", {{"extensions", {{"KHR_materials_pbrSpecularGlossiness", old}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coordinates}, {"TEXCOORD_2", coordinates}},
                {{"material", 1}});
  file.add_root(
      {{"mesh", 1}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"_ID", times}}}}}}}});
  for (const int mode : {0, 1, 5})
    file.add_mesh({{"POSITION", positions}, {"COLOR_0", colors}}, {{"mode", mode}, {"material", 1}});
  json& primitive = file.json["meshes"][1]["primitives"][0];
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 0}, {"variants", {0}}}};
  file.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "other"}}};
  file.json["extensions"]["KHR_xmp_json_ld"]["packets"] = {{{"dc:title", "all"}}};
  const json harmonics = json(std::vector<std::vector<float>>(9, {0.5f, 0.25f, 0.125f}));
  file.json["extensions"]["EXT_lights_image_based"]["lights"] = {{{"intensity", 2},
                                                                  {"rotation", {0, 0, 0, 1}},
                                                                  {"irradianceCoefficients", harmonics},
                                                                  {"specularImageSize", 1},
                                                                  {"specularImages", {{0, 0, 0, 0, 0, 0}}}}};
  file.json["scenes"][0]["extensions"]["EXT_lights_image_based"]["light"] = 0;
  file.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  add_pointers(file, times);
  file.json["extensionsUsed"] = {"KHR_lights_punctual",    "EXT_mesh_gpu_instancing", "KHR_texture_transform",
                                 "KHR_materials_variants", "EXT_lights_image_based",  "KHR_node_visibility",
                                 "KHR_animation_pointer"};
  return file;
}

/// Where the file names its buffer itself.
void tell_length(GltfFile& file) {
  if (file.json.contains("buffers")) file.json["buffers"][0]["byteLength"] = file.buffer.size();
}

/// The file with its first node going somewhere, as all here are read at a time of their animation.
GltfFile animated(GltfFile file) {
  const json linear = {{"input", file.add_accessor(std::vector<float>{0, 1}, "SCALAR")},
                       {"output", file.add_accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, "VEC3")}};
  file.add("animations",
           {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
            {"samplers", {linear}}});
  tell_length(file);
  return file;
}

/// A triangle with a KTX2 texture of one kind.
GltfFile with_ktx2(const char* fixture) {
  GltfFile file;
  const int positions = file.add_accessor(GltfFile::triangle_positions(), "VEC3");
  const int coordinates = file.add_accessor(std::vector<float>{0, 0, 1, 0, 0, 1}, "VEC2");
  file.add("images", {{"bufferView", file.add_view(ktx2_fixture(fixture))}, {"mimeType", "image/ktx2"}});
  file.add("textures", {{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}});
  file.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  file.add_mesh({{"POSITION", positions}, {"TEXCOORD_0", coordinates}}, {{"material", 0}});
  file.json["extensionsUsed"] = {"KHR_texture_basisu"};
  return animated(file);
}

class Mutator {
 public:
  explicit Mutator(uint64_t seed) : engine_(seed) {}

  /// One value of the document becomes another, goes, or trades places with its neighbors' kind.
  void change(json& document) {
    const json flat = document.flatten();
    const json::json_pointer place = above(json::json_pointer(pick(flat).first));
    static const json values = {nullptr,
                                true,
                                -1,
                                0,
                                1,
                                2,
                                255,
                                65536,
                                2147483647,
                                4294967295u,
                                9007199254740993,
                                1e30,
                                3.5e38,
                                1.7e308,
                                0.5,
                                -1e-30,
                                "",
                                "VEC3",
                                "SCALAR",
                                "../x",
                                "data:,",
                                json::array(),
                                json::object(),
                                {0, 0, 0},
                                {{"index", 7}}};
    if (below(4) == 0 && !place.empty()) {
      json& parent = document[place.parent_pointer()];
      if (parent.is_object())
        parent.erase(place.back());
      else
        parent.erase(std::stoul(place.back()));
    } else if (below(3) == 0) {
      document[place] = json(pick(flat).second);
    } else {
      document[place] = values[below(values.size())];
    }
  }

  /// One stretch of bytes is turned, doubled or lost.
  void change(std::string& bytes) {
    const size_t at = below(bytes.size()), count = std::min(1 + below(8), bytes.size() - at);
    const size_t kind = below(4);
    if (kind == 0) bytes.erase(at, count);
    if (kind == 1) bytes.insert(at, bytes.substr(at, count));
    if (kind == 2) bytes[at] = char(bytes[at] ^ (1 << below(8)));
    if (kind == 3) bytes.replace(at, count, count, below(2) == 0 ? '\xff' : '\0');
  }

  size_t below(size_t n) { return size_t(engine_() % n); }

 private:
  std::pair<std::string, json> pick(const json& flat) {
    auto item = flat.begin();
    std::advance(item, std::ptrdiff_t(below(flat.size())));
    return {item.key(), item.value()};
  }
  /// The place itself, or sometimes something that holds it.
  json::json_pointer above(json::json_pointer place) {
    while (!place.empty() && !place.parent_pointer().empty() && below(4) == 0) place = place.parent_pointer();
    return place;
  }

  std::mt19937_64 engine_;
};

/// Reads, builds and traces the scene; returns what it was refused with, nothing when it was not. Anything
/// but an Error goes on to the test.
std::string refusal(const std::string& path) {
  try {
    ImportOptions options;
    options.time = 0.5;
    const Scene scene(import_scene(path, options), {});
    Ray ray;
    ray.origin = {0.2f, 0.2f, 50};
    ray.direction = {0, 0, -1};
    if (const auto hit = scene.intersect(ray)) scene.shade(*hit, -ray.direction);
    return {};
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::StartsWith(path + ": "));
    EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
    // Of usage when the damage takes the animation away that is asked for.
    EXPECT_THAT(e.kind(), testing::AnyOf(ErrorKind::input, ErrorKind::usage)) << e.what();
    return e.what();
  }
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// Reads mutants; save(seed, folder) writes one and returns its path.
template <typename Save>
void expect_read_or_refused(uint64_t usual, const Save& save) {
  const TemporaryFolder folder;
  const long before = peak_megabytes();
  const uint64_t count = asked_or("VERNIER_MUTANTS", usual);
  uint64_t read = 0;
  for (uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    EXPECT_NO_THROW(read += refusal(save(seed, folder)).empty());
  }
  // Neither all nor none: otherwise the damage is too little or too great to test anything.
  EXPECT_GT(read, count / 20);
  EXPECT_LT(read, count - count / 20);
  // A file of kilobytes; AddressSanitizer keeps up to 256 MB of what was freed.
  EXPECT_LT(peak_megabytes() - before, 1024);
}

/// With one to three changes to the buffer.
void expect_buffers_read_or_refused(uint64_t usual, const GltfFile& original) {
  expect_read_or_refused(usual, [&](uint64_t seed, const TemporaryFolder& folder) {
    Mutator mutator(seed);
    GltfFile file = original;
    for (size_t changes = 1 + mutator.below(3); changes > 0; --changes) mutator.change(file.buffer);
    tell_length(file);
    return file.save(folder);
  });
}

TEST(ImportMutations, TheUnchangedFilesAreRead) {
  const TemporaryFolder folder;
  for (const GltfFile& file : {everything(), animated(draco_grid(Grid(3))), animated(meshopt_grid(Grid(3))),
                               with_ktx2("etc1s_alpha"), with_ktx2("uastc_zstandard")}) {
    EXPECT_EQ(refusal(file.save(folder)), "");
    if (!file.json.contains("buffers")) {
      EXPECT_EQ(refusal(folder.write("scene.glb", file.glb())), "");
    }
  }
}

TEST(ImportMutations, TheLargestSetOfCoordinatesIsNoNumberBelowZero) {
  const TemporaryFolder folder;
  GltfFile file = everything();
  json& layers = file.json["materials"][0]["extensions"];
  layers["KHR_materials_clearcoat"]["clearcoatTexture"]["texCoord"] = 2147483647;
  EXPECT_EQ(refusal(folder.write("layer.glb", file.glb())), "");
  layers["KHR_materials_clearcoat"]["clearcoatTexture"]["extensions"]["KHR_texture_transform"]["texCoord"] =
      2147483647;
  EXPECT_EQ(refusal(folder.write("transform.glb", file.glb())), "");
}

TEST(ImportMutations, ChangedJsonIsReadOrRefused) {
  const GltfFile original = everything();
  expect_read_or_refused(1000, [&](uint64_t seed, const TemporaryFolder& folder) {
    Mutator mutator(seed);
    GltfFile file = original;
    for (size_t changes = 1 + mutator.below(2); changes > 0; --changes) mutator.change(file.json);
    return folder.write("scene.glb", file.glb());
  });
}

TEST(ImportMutations, ChangedBytesAreReadOrRefused) {
  const std::string original = everything().glb();
  expect_read_or_refused(1000, [&](uint64_t seed, const TemporaryFolder& folder) {
    Mutator mutator(seed);
    std::string bytes = original;
    for (size_t changes = 1 + mutator.below(2); changes > 0; --changes) mutator.change(bytes);
    return folder.write("scene.glb", bytes);
  });
}

TEST(ImportMutations, ChangedBuffersAreReadOrRefused) { expect_buffers_read_or_refused(500, everything()); }
TEST(ImportMutations, ChangedDracoIsReadOrRefused) {
  expect_buffers_read_or_refused(300, animated(draco_grid(Grid(3))));
}
TEST(ImportMutations, ChangedMeshoptIsReadOrRefused) {
  expect_buffers_read_or_refused(300, animated(meshopt_grid(Grid(3))));
}
TEST(ImportMutations, ChangedEtc1sIsReadOrRefused) {
  expect_buffers_read_or_refused(300, with_ktx2("etc1s_alpha"));
}
TEST(ImportMutations, ChangedUastcIsReadOrRefused) {
  expect_buffers_read_or_refused(300, with_ktx2("uastc_zstandard"));
}

}  // namespace
}  // namespace vernier::test
