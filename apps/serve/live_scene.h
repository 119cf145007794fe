// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <shared_mutex>
#include <string>
#include <vector>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "scene/scene.h"
#include "vernier/scene_file.h"

namespace vernier::apps {

/// What the ray through the middle of a pixel meets.
struct SeenThing {
  std::string object, material;
  float distance = 0;  ///< metres along the camera's axis
  Vec3f position{0, 0, 0};
};

/// A scene file, posed, built and surrounded as views ask for it. One thread changes it, others may look.
class LiveScene {
 public:
  /// `background` is the picture behind it, if there is to be one. Throws Error(input).
  LiveScene(const std::string& path, const ImportOptions& options,
            std::shared_ptr<const Image> background = nullptr);

  const SceneFile& file() const { return file_; }

  /// Makes the scene what the request asks for, and returns the settings of its picture. What depends on
  /// nothing that has changed since the last call stays as it is. No session may be rendering. Throws Error.
  RenderSettings prepare(const RenderRequest& request, NoticeLog& log);

  /// As it was prepared last.
  const std::shared_ptr<Scene>& scene() const { return built_.scene; }
  /// Grows with each change of what samples depend on beside the settings.
  uint64_t version() const { return version_; }
  /// As --env takes it, or "scene" for the scene's own.
  const std::string& surroundings() const { return surroundings_.name; }
  std::vector<std::string> camera_names() const;
  /// Of what the camera is to go around.
  Bounds subject_bounds() const;

  /// Shared by threads that look at the scene for longer, but for the one that changes it.
  std::shared_mutex& mutex() { return mutex_; }

  /// Of the picture prepared last; empty where there is nothing. Callable from any thread.
  std::optional<SeenThing> look_at(int x, int y) const;

 private:
  /// What the file is at one time and in one variant.
  struct Built {
    std::vector<Notice> notices;
    std::vector<CameraDescription> cameras;
    std::vector<std::string> objects, materials;  ///< names, by instance
    std::shared_ptr<const EnvironmentDescription> environment;
    std::shared_ptr<Scene> scene;
  };

  void build(const RenderRequest& request, NoticeLog& log);
  void set_environment(const RenderRequest& request, const RenderSettings& settings, NoticeLog& log);
  /// Those asked for, their picture read once.
  std::optional<Surroundings> read(const SurroundingsFlags& flags);

  /// Held by who changes what follows, shared by other threads that look at it.
  mutable std::shared_mutex mutex_;
  SceneFile file_;
  const std::shared_ptr<const Image> background_;
  Built built_;
  std::string built_for_;
  std::map<std::string, Surroundings> plain_;  ///< those read so far, neither turned nor scaled
  Surroundings surroundings_{"scene", nullptr};
  std::vector<Notice> surroundings_notices_;
  std::string surrounded_for_;
  std::string fog_;                   ///< as --fog takes it
  bool has_own_surroundings_ = true;  ///< the scene, at present
  RenderSettings settings_;           ///< of the picture prepared last
  uint64_t version_ = 0;
};

}  // namespace vernier::apps
