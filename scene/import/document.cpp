// SPDX-License-Identifier: Apache-2.0
#include "scene/import/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/base/fingerprint.h"
#include "core/base/resident_memory.h"
#include "scene/import/container.h"
#include "scene/import/features.h"
#include "scene/import/json_text.h"
#include "scene/import/meshopt.h"
#include "scene/import/ordered_parallel.h"
#include "scene/import/schema.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using nlohmann::json;

/// Version 1.0 is another format altogether, which is said before the schema finds everything in it wrong; so
/// nothing is known of the types here.
void check_version(const json& root, const std::string& file) {
  const auto text_at = [&](const char* pointer, const char* otherwise) {
    const json::json_pointer place(pointer);
    return root.contains(place) && root[place].is_string() ? root[place].get<std::string>() : otherwise;
  };
  const std::string version = text_at("/asset/version", "2.0");
  if (!version.starts_with("2.") || text_at("/asset/minVersion", "2.0") != "2.0")
    throw Error(ErrorKind::input, file, "/asset/version",
                fmt::format("glTF {} cannot be read, only 2.0; convert the file to glTF 2.0", version));
}

/// An extension that is required and not honoured may make anything look wrong, so it is named first; nothing
/// is known of the types here either.
void check_required_extensions(const json& root, const std::string& file) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end() || !required->is_array()) return;
  for (size_t i = 0; i < required->size(); ++i) {
    if (!(*required)[i].is_string()) continue;
    const FeatureUse use = extension_use((*required)[i].get<std::string>());
    if (use.status == FeatureUse::Status::ignored)
      throw Error(ErrorKind::input, file, fmt::format("/extensionsRequired/{}", i),
                  fmt::format("the file requires {}, which is not supported: {}", use.name, use.note));
  }
}

/// Both name the same thing; the second adds to what its data may be.
constexpr std::array<const char*, 2> meshopt_names{"EXT_meshopt_compression", "KHR_meshopt_compression"};

bool is_meshopt_fallback(const json& buffer) {
  if (!buffer.contains("extensions")) return false;
  const json& extensions = buffer["extensions"];
  return std::any_of(meshopt_names.begin(), meshopt_names.end(), [&](const char* name) {
    return extensions.contains(name) && extensions[name].value("fallback", false);
  });
}

/// Strings that are no UTF-8 are mended.
std::string text_of(const json& tree) { return tree.dump(-1, ' ', false, json::error_handler_t::replace); }

}  // namespace

Document::Document(AssetFiles files) : files_(std::move(files)) {
  const std::string& path = files_.scene_path();
  Bytes file = files_.read_scene();
  fingerprints_.push_back(fingerprint(file.span()));
  const Container container = split_container(file.span(), path);
  json root = parse_json(container.json, path);
  check_version(root, path);
  check_required_extensions(root, path);
  check_against_schema(root, gltf_schema(), path, notices_);
  read_buffers(root, container.binary);
  if (!container.binary.empty()) storage_.push_back(std::move(file));
  read_image_sources(root);
  parse_model(root);
  alike_primitives_ = AlikePrimitives(model_);
  locate_views();
}

void Document::fail(const std::string& place, const std::string& problem) const {
  throw Error(ErrorKind::input, files_.scene_path(), place, problem);
}

void Document::read_buffers(const json& root, std::span<const uint8_t> binary_chunk) {
  if (!root.contains("buffers")) return;
  const json& buffers = root["buffers"];
  for (size_t i = 0; i < buffers.size(); ++i) {
    const json& buffer = buffers[i];
    const std::string place = fmt::format("/buffers/{}", i);
    std::span<const uint8_t> bytes = i == 0 ? binary_chunk : std::span<const uint8_t>();
    // Nothing reads what a compressed copy replaces, and it need not be there.
    if (is_meshopt_fallback(buffer)) {
      buffers_.emplace_back();
      continue;
    }
    if (buffer.contains("uri")) {
      AssetContent content = files_.read_uri(buffer["uri"].get_ref<const std::string&>(), place + "/uri");
      if (!content.problem.empty()) fail(place + "/uri", content.problem);
      if (!content.remark.empty())
        notices_.push_back({Notice::Severity::warning, place + "/uri", content.remark});
      storage_.push_back(std::move(content.bytes));
      bytes = storage_.back().span();
      fingerprints_.push_back(fingerprint(bytes));
    } else if (bytes.empty()) {
      // Nothing may use it, and only then it does no harm: see view().
      buffers_.emplace_back();
      continue;
    }
    const size_t length = buffer["byteLength"];
    if (length > bytes.size())
      fail(place + "/byteLength", fmt::format("{} bytes expected, there are {}", length, bytes.size()));
    buffers_.push_back(bytes.first(length));
  }
}

void Document::read_image_sources(const json& root) {
  if (!root.contains("images")) return;
  const json& images = root["images"];
  for (size_t i = 0; i < images.size(); ++i) {
    const bool has_uri = images[i].contains("uri"), has_view = images[i].contains("bufferView");
    if (has_uri == has_view) fail(fmt::format("/images/{}", i), "expected either a uri or a bufferView");
    images_.push_back({images[i].value("uri", ""), images[i].value("bufferView", -1)});
  }
}

void Document::complete_spot_lights(json& root) {
  const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  if (!root.contains(lights)) return;
  for (size_t i = 0; i < root[lights].size(); ++i) {
    json& light = root[lights][i];
    if (light["type"] != "spot" || light.contains("spot")) continue;
    light["spot"] = json::object();
    notices_.push_back({Notice::Severity::warning, fmt::format("{}/{}", lights.to_string(), i),
                        "'spot' is missing; the default cone is used"});
  }
}

void Document::normalize_colors(json& root) {
  if (!root.contains("meshes") || !root.contains("accessors")) return;
  size_t mended = 0;
  for (const auto& mesh : root["meshes"])
    for (const auto& primitive : mesh["primitives"]) {
      if (!primitive["attributes"].contains("COLOR_0")) continue;
      json& accessor = root["accessors"][primitive["attributes"]["COLOR_0"].get<size_t>()];
      constexpr int float_type = 5126;
      if (accessor["componentType"] == float_type || accessor.value("normalized", false)) continue;
      accessor["normalized"] = true;
      ++mended;
    }
  if (mended)
    notices_.push_back({Notice::Severity::warning, "/accessors",
                        fmt::format("{} accessors of COLOR_0 hold integers that are not said to be "
                                    "normalized; they are taken for that",
                                    mended)});
}

void Document::parse_model(json& root) {
  root.erase("buffers");
  root.erase("images");
  // Nothing needs the bounds of accessors, and some cannot be parsed as numbers.
  if (root.contains("accessors"))
    for (auto& accessor : root["accessors"]) {
      accessor.erase("min");
      accessor.erase("max");
    }
  complete_spot_lights(root);
  normalize_colors(root);
  prepare_pointers(root);
  // tinygltf refuses indices whose accessor has no buffer view, as compressed and sparse ones have not. They
  // get one that does not exist, and it is taken away again below.
  const int no_view = root.contains("bufferViews") ? int(root["bufferViews"].size()) : 0;
  if (root.contains("accessors"))
    for (auto& accessor : root["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = no_view;
  root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});

  json nodes = root.contains("nodes") ? std::move(root["nodes"]) : json::array();
  root.erase("nodes");
  parse_text(text_of(root), model_);
  root = json();
  model_.bufferViews.pop_back();
  for (auto& accessor : model_.accessors)
    if (accessor.bufferView == no_view) accessor.bufferView = -1;
  parse_nodes(std::move(nodes));
}

void Document::parse_nodes(json nodes) {
  // In parts, each taken out of the tree before it is given to tinygltf, which makes a tree of its own: files
  // have more nodes than anything else.
  constexpr size_t at_once = 4096, between_trims = 32 * at_once;
  nodes_.reserve(nodes.size());
  for (size_t begin = 0; begin < nodes.size(); begin += at_once) {
    json part{{"asset", {{"version", "2.0"}}}, {"nodes", json::array()}};
    for (size_t i = begin; i < std::min(nodes.size(), begin + at_once); ++i)
      part["nodes"].push_back(std::move(nodes[i]));
    const std::string text = text_of(part);
    part = json();
    tinygltf::Model model;
    parse_text(text, model);
    for (tinygltf::Node& node : model.nodes)
      nodes_.push_back({std::move(node.name), node.mesh, node.camera, node.skin, std::move(node.children),
                        std::move(node.rotation), std::move(node.scale), std::move(node.translation),
                        std::move(node.matrix), std::move(node.weights), std::move(node.extensions)});
    if (begin % between_trims == between_trims - at_once) give_back_freed_memory();
  }
}

void Document::parse_text(const std::string& text, tinygltf::Model& model) const {
  if (text.size() > std::numeric_limits<unsigned>::max()) fail("", "more than 4 GiB of JSON");
  tinygltf::TinyGLTF parser;
  std::string errors, warnings;
  if (!parser.LoadASCIIFromString(&model, &errors, &warnings, text.data(), unsigned(text.size()), "",
                                  tinygltf::NO_REQUIRE)) {
    std::replace(errors.begin(), errors.end(), '\n', ' ');
    fail("", "not a valid glTF file: " + errors);
  }
}

void Document::prepare_pointers(json& root) {
  if (!root.contains("animations")) return;
  bool pointers = false;
  for (auto& animation : root["animations"])
    for (auto& channel : animation["channels"]) {
      json& target = channel["target"];
      pointers = pointers || target["path"] == "pointer";
      if (!target.contains("node")) target["node"] = -1;
    }
  if (!pointers) return;
  json parts = {{"asset", {{"version", "2.0"}}}};
  for (const char* part : {"materials", "cameras", "extensions"})
    if (root.contains(part)) parts[part] = root[part];
  animatable_ = std::make_shared<const json>(std::move(parts));
}

void Document::set_properties(std::span<const PropertyValue> values) {
  if (!animatable_) return;
  json parts = *animatable_;
  for (const auto& [pointer, value] : values) {
    json& property = parts[json::json_pointer(pointer)];
    property = value.size() == 1 ? json(value[0]) : json(value);
  }
  tinygltf::Model changed;
  parse_text(text_of(parts), changed);
  model_.materials = std::move(changed.materials);
  model_.cameras = std::move(changed.cameras);
  model_.lights = std::move(changed.lights);
  model_.extensions = std::move(changed.extensions);
}

std::span<const uint8_t> Document::locate(int buffer, size_t offset, size_t length,
                                          const std::string& place) const {
  const auto bytes = buffers_[size_t(buffer)];
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(place, fmt::format("{} bytes from byte {} on are not in buffer {}, which has {}", length, offset,
                            buffer, bytes.size()));
  return bytes.subspan(offset, length);
}

std::span<const uint8_t> Document::view(int index) const {
  const auto bytes = views_[size_t(index)];
  if (bytes.empty())
    fail(fmt::format("/buffers/{}", model_.bufferViews[size_t(index)].buffer),
         "the buffer has no uri and the file has no binary chunk for it");
  return bytes;
}

size_t Document::buffer_bytes() const {
  size_t sum = 0;
  for (const auto& buffer : buffers_) sum += buffer.size();
  return sum;
}

void Document::locate_views() {
  const auto& views = model_.bufferViews;
  views_.resize(views.size());
  std::vector<Bytes> decoded(views.size());
  for_each_in_parallel(views.size(), [&](size_t i) {
    const std::string place = fmt::format("/bufferViews/{}", i);
    for (const char* name : meshopt_names) {
      const auto compression = views[i].extensions.find(name);
      if (compression == views[i].extensions.end()) continue;
      decoded[i] = decompress(compression->second, place + "/extensions/" + name);
      views_[i] = decoded[i].span();
      return;
    }
    if (buffers_[size_t(views[i].buffer)].empty()) return;
    views_[i] = locate(views[i].buffer, views[i].byteOffset, views[i].byteLength, place);
  });
  for (auto& bytes : decoded)
    if (bytes.data) storage_.push_back(std::move(bytes));
}

Bytes Document::decompress(const tinygltf::Value& meshopt, const std::string& place) const {
  const auto size = [&](const char* name) { return size_t(meshopt.Get(name).GetNumberAsInt()); };
  MeshoptView view;
  view.compressed = locate(meshopt.Get("buffer").GetNumberAsInt(),
                           meshopt.Has("byteOffset") ? size("byteOffset") : 0, size("byteLength"), place);
  view.count = size("count");
  view.stride = size("byteStride");
  view.mode = meshopt.Get("mode").Get<std::string>();
  view.filter = meshopt.Has("filter") ? meshopt.Get("filter").Get<std::string>() : "NONE";
  Bytes decoded;
  if (const std::string problem = decode_meshopt(view, decoded); !problem.empty()) fail(place, problem);
  return decoded;
}

}  // namespace vernier
