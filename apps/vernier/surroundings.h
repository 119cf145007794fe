// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "apps/vernier/commands.h"
#include "apps/vernier/notice_log.h"
#include "integrators/render/render.h"
#include "vernier/scene.h"

namespace vernier {

class Camera;
class Scene;

namespace apps {

/// --env, --env-rotate and --env-scale, as typed, and what memory there is for them.
struct SurroundingsFlags {
  std::string environment;  ///< none, a built-in one, a file; empty: not given
  float rotate = 0;         ///< degrees
  float scale = 1;
  uint64_t max_memory = 0;  ///< --max-memory in bytes; 0: without
};

/// Declares the flags on `command`.
void add_surroundings_flags(CLI::App& command, SurroundingsFlags& flags);

/// What is around a scene.
struct Surroundings {
  std::string name;  ///< as --env takes it, or "scene" for the scene's own
  std::shared_ptr<const EnvironmentDescription> environment;  ///< null: nothing
  bool turns_with_camera = false;
};

/// Pictures of surroundings, each decoded once for as long as somebody has it. For several threads at a time.
class EnvironmentPictures {
 public:
  /// Throws Error(input), also where a picture has no room within `max_memory` (0: without).
  std::shared_ptr<const Image> read(const std::string& file, uint64_t max_memory);

 private:
  std::mutex mutex_;
  std::map<std::string, std::weak_ptr<const Image>> pictures_;
};

/// Throws Error when the flags contradict each other, or name what is neither there nor built in. Decodes no
/// picture, so that this can be told before anything takes time.
void check_surroundings(const SurroundingsFlags& flags);

/// Those that the flags ask for; none when they leave it to the scene. Throws Error.
std::optional<Surroundings> read_surroundings(const SurroundingsFlags& flags, EnvironmentPictures& pictures);
/// The same where no others are read.
std::optional<Surroundings> read_surroundings(const SurroundingsFlags& flags);
/// Others, neither turned nor scaled, as the flags turn and scale them.
Surroundings turned_and_scaled(const Surroundings& plain, const SurroundingsFlags& flags);

/// The scene with nothing but them around it, if there are any, and a note if it had some of its own.
void replace_surroundings(SceneDescription& description, const std::optional<Surroundings>& asked,
                          NoticeLog& log);

/// Puts around `scene`, made of such a description, what it is rendered in by that camera, and says what that
/// is: what was asked for; else its own where it has some, or where its lights light what the camera sees
/// (integrators/visible_light.h); else the studio, with a note. `options` has the picture's size.
Surroundings set_environment(Scene& scene, const std::optional<Surroundings>& asked,
                             const CameraDescription& view, const RenderSettings& options, NoticeLog& log);

}  // namespace apps
}  // namespace vernier
