// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vernier/scene.h"

namespace vernier {

/// An animation of a file: its name, which may be empty, and when its last key is, in seconds.
struct AnimationSpan {
  std::string name;
  double seconds = 0;
};

/// A .gltf or .glb file in memory, to be described at several times and in several variants. What depends on
/// neither, such as textures, materials and meshes that do not change their shape, is read once, and shared
/// or copied from then on. For one thread at a time.
class VERNIER_API SceneFile {
 public:
  /// Throws Error(input) as import_scene() does; `allow_outside_files` as in ImportOptions.
  explicit SceneFile(const std::string& path, bool allow_outside_files = false);
  /// A file whose bytes are in memory and may go afterwards; `name` is what errors call it. It lies in no
  /// folder, so Error(input) is thrown where it refers to another file.
  SceneFile(const std::string& name, std::span<const uint8_t> bytes);
  ~SceneFile();
  SceneFile(const SceneFile&) = delete;
  SceneFile& operator=(const SceneFile&) = delete;

  /// The same description as import_scene() gives with these options, of which allow_outside_files counts no
  /// more.
  SceneDescription describe(const ImportOptions& options = {});

  /// Names of the file's variants (KHR_materials_variants), in its order.
  std::vector<std::string> variants() const;
  /// In the file's order.
  std::vector<AnimationSpan> animations() const;

 private:
  friend SceneDescription import_scene(const std::string& path, const ImportOptions& options);

  class Content;
  std::unique_ptr<Content> content_;
};

}  // namespace vernier
