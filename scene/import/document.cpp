#include "scene/import/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/fingerprint.h"
#include "scene/import/container.h"
#include "scene/import/meshopt.h"
#include "scene/import/ordered_parallel.h"
#include "scene/import/schema.h"

namespace vernier {
namespace {

using nlohmann::json;

// tinygltf walks nested values recursively; real files stay below twenty levels.
constexpr int max_json_depth = 128;

/// Throws Error(input) when arrays and objects are nested deeper than max_json_depth.
void check_depth(std::span<const uint8_t> text, const std::string& file) {
  int depth = 0;
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const uint8_t c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > max_json_depth)
        throw Error(ErrorKind::input, file, fmt::format("byte {}", i),
                    fmt::format("JSON nested deeper than {} levels", max_json_depth));
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
}

json parse_json(std::span<const uint8_t> text, const std::string& file) {
  check_depth(text, file);
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..." and the like.
    std::string message = e.what();
    if (const size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    if (message.size() > 300) message = message.substr(0, 297) + "...";
    throw Error(ErrorKind::input, file, "JSON", message);
  }
}

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

bool is_meshopt_fallback(const json& buffer) {
  if (!buffer.contains("extensions") || !buffer["extensions"].contains("EXT_meshopt_compression"))
    return false;
  return buffer["extensions"]["EXT_meshopt_compression"].value("fallback", false);
}

}  // namespace

Document::Document(const std::string& path) : files_(path) {
  Bytes file = files_.read_scene();
  fingerprints_.push_back(fingerprint(file.span()));
  const Container container = split_container(file.span(), path);
  json root = parse_json(container.json, path);
  check_version(root, path);
  check_against_schema(root, gltf_schema(), path);
  read_buffers(root, container.binary);
  if (!container.binary.empty()) storage_.push_back(std::move(file));
  read_image_sources(root);
  parse_model(root);
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
      storage_.push_back(files_.read_uri(buffer["uri"].get_ref<const std::string&>(), place + "/uri"));
      bytes = storage_.back().span();
      fingerprints_.push_back(fingerprint(bytes));
    } else if (bytes.empty()) {
      fail(place, "the buffer has no uri and the file has no binary chunk for it");
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

void Document::parse_model(json& root) {
  root.erase("buffers");
  root.erase("images");
  // tinygltf refuses indices whose accessor has no buffer view, as compressed and sparse ones have not. They
  // get one that does not exist, and it is taken away again below.
  const int no_view = root.contains("bufferViews") ? int(root["bufferViews"].size()) : 0;
  if (root.contains("accessors"))
    for (auto& accessor : root["accessors"])
      if (!accessor.contains("bufferView")) accessor["bufferView"] = no_view;
  root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 1}});

  const std::string text = root.dump(-1, ' ', false, json::error_handler_t::replace);
  root = json();
  if (text.size() > std::numeric_limits<unsigned>::max()) fail("", "more than 4 GiB of JSON");
  tinygltf::TinyGLTF parser;
  std::string errors, warnings;
  if (!parser.LoadASCIIFromString(&model_, &errors, &warnings, text.data(), unsigned(text.size()), "",
                                  tinygltf::NO_REQUIRE)) {
    std::replace(errors.begin(), errors.end(), '\n', ' ');
    fail("", "not a valid glTF file: " + errors);
  }
  model_.bufferViews.pop_back();
  for (auto& accessor : model_.accessors)
    if (accessor.bufferView == no_view) accessor.bufferView = -1;
}

std::span<const uint8_t> Document::locate(int buffer, size_t offset, size_t length,
                                          const std::string& place) const {
  const auto bytes = buffers_[size_t(buffer)];
  if (offset > bytes.size() || length > bytes.size() - offset)
    fail(place, fmt::format("{} bytes from byte {} on are not in buffer {}, which has {}", length, offset,
                            buffer, bytes.size()));
  return bytes.subspan(offset, length);
}

void Document::locate_views() {
  const auto& views = model_.bufferViews;
  views_.resize(views.size());
  std::vector<Bytes> decoded(views.size());
  for_each_in_parallel(views.size(), [&](size_t i) {
    const std::string place = fmt::format("/bufferViews/{}", i);
    const auto compression = views[i].extensions.find("EXT_meshopt_compression");
    if (compression == views[i].extensions.end()) {
      views_[i] = locate(views[i].buffer, views[i].byteOffset, views[i].byteLength, place);
      return;
    }
    const auto& values = compression->second;
    const auto size = [&](const char* name) { return size_t(values.Get(name).GetNumberAsInt()); };
    MeshoptView view;
    view.compressed =
        locate(values.Get("buffer").GetNumberAsInt(), values.Has("byteOffset") ? size("byteOffset") : 0,
               size("byteLength"), place + "/extensions/EXT_meshopt_compression");
    view.count = size("count");
    view.stride = size("byteStride");
    view.mode = values.Get("mode").Get<std::string>();
    view.filter = values.Has("filter") ? values.Get("filter").Get<std::string>() : "NONE";
    if (const std::string problem = decode_meshopt(view, decoded[i]); !problem.empty())
      fail(place + "/extensions/EXT_meshopt_compression", problem);
    views_[i] = decoded[i].span();
  });
  for (auto& bytes : decoded)
    if (bytes.data) storage_.push_back(std::move(bytes));
}

}  // namespace vernier
