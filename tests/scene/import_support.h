// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"
#include "vernier/error.h"
#include "vernier/scene.h"

namespace vernier::test {

/// A glTF document under construction, with one buffer.
struct GltfFile {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::string buffer;

  int add(const char* array, nlohmann::json object) {
    json[array].push_back(std::move(object));
    return int(json[array].size()) - 1;
  }

  /// Appends data, aligned to four bytes, as a buffer view.
  template <typename T>
  int add_view(const std::vector<T>& data, nlohmann::json extra = nlohmann::json::object()) {
    buffer.resize((buffer.size() + 3) / 4 * 4);
    nlohmann::json view = {
        {"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", data.size() * sizeof(T)}};
    view.update(extra);
    buffer.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(T));
    return add("bufferViews", view);
  }

  /// Packed elements of a glTF type such as "VEC3".
  template <typename T>
  int add_accessor(const std::vector<T>& data, const std::string& type, bool normalized = false) {
    nlohmann::json accessor = {{"bufferView", add_view(data)},
                               {"componentType", component_type<T>()},
                               {"count", data.size() / components(type)},
                               {"type", type}};
    if (normalized) accessor["normalized"] = true;
    return add("accessors", accessor);
  }

  /// A mesh of one primitive and a node of the scene that shows it; returns the node.
  int add_mesh(nlohmann::json attributes, nlohmann::json primitive = nlohmann::json::object()) {
    primitive["attributes"] = std::move(attributes);
    const int mesh = add("meshes", {{"primitives", {primitive}}});
    return add_root({{"mesh", mesh}});
  }

  /// The triangle (0,0,0), (1,0,0), (0,1,0).
  int add_triangle(nlohmann::json primitive = nlohmann::json::object()) {
    return add_mesh({{"POSITION", add_accessor(triangle_positions(), "VEC3")}}, std::move(primitive));
  }
  static std::vector<float> triangle_positions() { return {0, 0, 0, 1, 0, 0, 0, 1, 0}; }

  int add_root(nlohmann::json node) {
    const int index = add("nodes", std::move(node));
    if (!json.contains("scenes")) json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  /// As text, with the buffer beside it as "data.bin".
  std::string save(const TemporaryFolder& folder, const std::string& name = "scene.gltf") const {
    nlohmann::json complete = json;
    if (!buffer.empty()) {
      folder.write("data.bin", buffer);
      if (!complete.contains("buffers"))
        complete["buffers"] = {{{"uri", "data.bin"}, {"byteLength", buffer.size()}}};
    }
    return folder.write(name, complete.dump());
  }

  /// As the bytes of a .glb, whose binary chunk is the buffer.
  std::string glb() const {
    nlohmann::json complete = json;
    if (!buffer.empty() && !complete.contains("buffers"))
      complete["buffers"] = {{{"byteLength", buffer.size()}}};
    std::string text = complete.dump(), binary = buffer;
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string bytes =
        "glTF" + word(2) + word(uint32_t(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size())));
    bytes += word(uint32_t(text.size())) + "JSON" + text;
    if (!binary.empty()) bytes += word(uint32_t(binary.size())) + std::string("BIN\0", 4) + binary;
    return bytes;
  }

  SceneDescription import(const ImportOptions& options = {}) const {
    const TemporaryFolder folder;
    return import_scene(save(folder), options);
  }

  static std::string word(uint32_t value) {
    std::string bytes(4, '\0');
    std::memcpy(bytes.data(), &value, 4);
    return bytes;
  }

 private:
  template <typename T>
  static int component_type() {
    if constexpr (std::is_same_v<T, int8_t>) return 5120;
    if constexpr (std::is_same_v<T, uint8_t>) return 5121;
    if constexpr (std::is_same_v<T, int16_t>) return 5122;
    if constexpr (std::is_same_v<T, uint16_t>) return 5123;
    if constexpr (std::is_same_v<T, uint32_t>) return 5125;
    return 5126;
  }
  static size_t components(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : size_t(type.back() - '0');
  }
};

/// What importing throws, or an empty string.
inline std::string import_error(const std::string& path, const ImportOptions& options = {}) {
  try {
    import_scene(path, options);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

inline std::string import_error(const GltfFile& file, const ImportOptions& options = {}) {
  const TemporaryFolder folder;
  return import_error(file.save(folder), options);
}

inline bool has_notice(const SceneDescription& scene, const std::string& part) {
  for (const auto& notice : scene.notices)
    if (notice.text.find(part) != std::string::npos) return true;
  return false;
}

}  // namespace vernier::test
