// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/import/alike_primitives.h"
#include "scene/import/asset_files.h"
#include "scene/import/tinygltf.h"
#include "vernier/error.h"

// Only sources under scene/import include this header, since it brings tinygltf in.

namespace vernier {

/// Where an image's file is: a URI, or a buffer view.
struct ImageSource {
  std::string uri;  ///< empty: in `view`
  int view = -1;
};

/// What is read of a node: tinygltf's own are twice as large, and files have millions.
struct FileNode {
  std::string name;
  int mesh = -1, camera = -1, skin = -1;
  std::vector<int> children;
  std::vector<double> rotation, scale, translation, matrix;  ///< empty: not given
  std::vector<double> weights;
  tinygltf::ExtensionMap extensions;
};

/// A number, or an array of them, that an animation sets.
struct PropertyValue {
  std::string pointer;  ///< JSON pointer of the property
  std::vector<double> value;
};

/// A glTF file, parsed and checked against the schema: every type is right, every index in range. tinygltf is
/// given the JSON without buffers and images, and so never opens a file itself: `model.buffers` and
/// `model.images` are empty, and so are `model.nodes`, in whose place nodes() are.
class Document {
 public:
  /// Reads the scene file and its buffers. Throws Error(input).
  explicit Document(AssetFiles files);

  const AssetFiles& files() const { return files_; }
  const tinygltf::Model& model() const { return model_; }
  const std::vector<FileNode>& nodes() const { return nodes_; }
  const AlikePrimitives& alike_primitives() const { return alike_primitives_; }
  const std::vector<ImageSource>& images() const { return images_; }

  /// What KHR_animation_pointer may change beyond nodes and meshes: the file's materials, cameras and
  /// extensions at rest. Null where no animation uses it.
  const nlohmann::json* animatable() const { return animatable_.get(); }
  /// Changes the model: these properties of animatable() have these values, all others are at rest.
  void set_properties(std::span<const PropertyValue> values);

  /// Bytes of a buffer view, decompressed. Throws Error(input) when its buffer has no data.
  std::span<const uint8_t> view(int index) const;
  /// Of all buffers together, as the file has them.
  size_t buffer_bytes() const;

  /// Fingerprints of the scene file and the buffers read, in order.
  const std::vector<std::string>& fingerprints() const { return fingerprints_; }

  /// What was put right while reading.
  const std::vector<Notice>& notices() const { return notices_; }

  /// Throws Error(input) about this file; `place` is a JSON pointer.
  [[noreturn]] void fail(const std::string& place, const std::string& problem) const;

 private:
  void read_buffers(const nlohmann::json& json, std::span<const uint8_t> binary_chunk);
  void read_image_sources(const nlohmann::json& json);
  void parse_model(nlohmann::json& json);
  void parse_nodes(nlohmann::json nodes);
  void parse_text(const std::string& text, tinygltf::Model& model) const;
  /// Gives spot lights without a cone, which tinygltf refuses, the default one.
  void complete_spot_lights(nlohmann::json& root);
  /// Colours in integers are fractions of the largest, said or not (glTF 2.0, 3.7.2.1).
  void normalize_colors(nlohmann::json& root);
  /// Keeps what set_properties() changes, and gives channels without a node, which tinygltf drops, one that
  /// does not exist.
  void prepare_pointers(nlohmann::json& root);
  void locate_views();
  /// The bytes that a buffer view's meshopt extension stands for.
  Bytes decompress(const tinygltf::Value& meshopt, const std::string& place) const;
  std::span<const uint8_t> locate(int buffer, size_t offset, size_t length, const std::string& place) const;

  AssetFiles files_;
  tinygltf::Model model_;
  std::vector<FileNode> nodes_;
  AlikePrimitives alike_primitives_;
  std::shared_ptr<const nlohmann::json> animatable_;
  std::vector<Bytes> storage_;
  std::vector<std::span<const uint8_t>> buffers_, views_;
  std::vector<ImageSource> images_;
  std::vector<std::string> fingerprints_;
  std::vector<Notice> notices_;
};

}  // namespace vernier
