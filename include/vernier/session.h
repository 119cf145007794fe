// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vernier/image.h"
#include "vernier/result.h"
#include "vernier/settings.h"

namespace vernier {

struct RenderResult;

/// Whether the scene's own lights leave what the camera sees dark; a few thousand paths tell.
VERNIER_API bool is_dark(const Scene& scene, const RenderSettings& settings);

/// A scene as it stands at one time, and from where it is seen then.
struct Moment {
  std::shared_ptr<const Scene> scene;
  CameraDescription camera;
};

/// The pictures before and after one, which the layer `motion` compares it with.
struct Moments {
  Moment previous, next;
};

/// One picture of a scene, rendered until its limits, and further when they grow. It prints nothing, has no
/// globals and catches no signals; several may run at once, each called by one thread at a time. Rendering
/// uses the threads of the calling thread's TBB arena. The same picture to the bit for any number of threads,
/// and wherever it was stopped and gone on with.
class VERNIER_API RenderSession {
 public:
  /// The scene must not change any more. Throws Error(usage) that says what to set when the settings have no
  /// size, a crop beyond the picture, an unknown integrator, or a camera with a defect.
  RenderSession(std::shared_ptr<const Scene> scene, RenderSettings settings);
  ~RenderSession();
  RenderSession(const RenderSession&) = delete;
  RenderSession& operator=(const RenderSession&) = delete;

  const RenderSettings& settings() const;
  void set_limits(const RenderLimits& limits);

  /// Tells a few times a second how far run() is, on a thread of its own.
  void on_progress(std::function<void(const RenderProgress&)> observe);
  /// Calls back while run() holds still: every `seconds` of rendering, and at its end. For save().
  void on_checkpoint(std::function<void()> save, double seconds);
  /// Calls back in the same way, every `seconds` of rendering and not at the end, to write() a picture of
  /// what is there. Where `now` is given and becomes true, by a signal for instance, this and the callback
  /// for checkpoints are called soon, and it is made false.
  void on_preview(std::function<void()> show, double seconds, std::atomic<bool>* now = nullptr);

  /// Goes on to the limits. `stop` may become true at any time, from another thread or a signal handler: it
  /// ends within about a tile. Throws Error(usage) while another thread is in a call to this session.
  StopReason run(const std::atomic<bool>& stop);
  StopReason run();

  /// All that it takes to go on elsewhere, to a file that is replaced wholly or not at all. Throws
  /// Error(output), and Error(usage) for a scene that nothing identifies (SceneDescription::hash).
  void save(const std::string& path) const;
  /// Goes on from such a file. Throws Error(input) when it is damaged or of another scene or other settings
  /// but for the limits. Tells whether it comes from another build or platform, whose last bits may differ.
  std::vector<Notice> load(const std::string& path);

  /// For the layer `motion`, which is refused without. Their scenes are other poses of the same description.
  void set_moments(Moments moments);

  RenderStatus status() const;
  /// R, G, B, scene-linear Rec.709, A if the background is transparent (colours multiplied by it), then the
  /// channels of `layers`: "error,albedo,...", or "all". Its texts say what was sampled and how wrong it is.
  LayeredImage picture(const std::string& layers = "") const;
  /// The same to a file, as write_picture() does. Throws Error(output).
  void write(const std::string& path, const std::string& layers = "") const;

  /// All that is known, for the project's own programs.
  const RenderResult& result() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace vernier
