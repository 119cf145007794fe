// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/film/error_estimate.h"
#include "core/film/film.h"
#include "integrators/integrator.h"
#include "integrators/render/missing_light.h"

namespace vernier {

class Backdrop;
class Camera;
class LightPaths;
class Scene;
struct RenderState;

/// A sample that was not finite or was negative, so that it can be replayed. x, y are in the full picture.
struct BadSample {
  int x = 0, y = 0;
  int half = 0;
  uint32_t index = 0;  ///< within the half
  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 reads what the compiler writes
  auto operator<=>(const BadSample&) const = default;
};

/// A part of a picture's light, sampled like the whole.
struct LightFilm {
  std::string layer;  ///< as pictures call it
  Film film;
};

/// The error that a render had reached after so many seconds and samples.
struct ConvergencePoint {
  double seconds, samples_per_pixel;
  ErrorEstimate error;
};

struct RenderResult {
  explicit RenderResult(Film empty) : film(std::move(empty)) {}

  Film film;                     ///< of the crop's size
  std::vector<LightFilm> light;  ///< parts of it that were asked for
  StopReason reason = StopReason::samples;
  ErrorEstimate error;
  std::vector<ConvergencePoint> convergence;  ///< after passes, in order, and at the end
  double seconds = 0;
  uint64_t samples = 0;
  RayCounts rays;
  MissingEstimate missing;                              ///< known bias, which `error` does not contain
  uint64_t bad_samples = 0;                             ///< rejected by the film
  LightPathKind light_path_kind = LightPathKind::none;  ///< followed beside camera samples
  uint64_t bad_light_paths = 0;                         ///< of which nothing was kept, for the same reasons
  std::vector<BadSample> bad_sample_examples;           ///< the first few by column, row, half and index
};

/// Called while a render is on its way.
struct RenderCallbacks {
  /// Runs on a thread of its own, so it delays only the end of render(), which waits for it to return. It is
  /// not called again once it has thrown.
  std::function<void(const RenderProgress&)> on_progress = {};
  /// Gets the state after each `checkpoint_interval` seconds of rendering, but no sooner than after twenty
  /// times as long as the last save took (0: after every tile), and once at the end. Called on the thread
  /// that called render() while nothing is rendered; its time counts nowhere.
  std::function<void(const RenderState&)> on_checkpoint = {};
  double checkpoint_interval = std::numeric_limits<double>::infinity();
  /// Gets the state in the same way, its error estimated, but also as soon as all pixels have samples, and
  /// not at the end.
  std::function<void(const RenderState&)> on_preview = {};
  double preview_interval = std::numeric_limits<double>::infinity();
  /// Where it becomes true, both are called soon whatever their intervals, and it is made false. Null: never.
  std::atomic<bool>* now = nullptr;
};

/// The whole picture where no crop is asked for.
Crop rendered_part(const RenderSettings& settings);

/// What is rendered: all that the samples depend on, and when to stop. Refers to things that live as long.
struct RenderJob {
  const Scene& scene;
  const Camera& camera;
  const Integrator& integrator;
  const RenderSettings& settings;
  const Backdrop& backdrop;
  const LightSorter& sorter;
  const LightPaths* light_paths = nullptr;  ///< whose splats belong to the picture; null: none
};

/// Renders tiles of the picture in passes on all threads, from where `state` is, of a render with the same
/// settings but for its limits, to the limits, which are of the whole render. The same bytes for any number
/// of threads, independent of where a render with the same limits was interrupted and resumed. `stop` may
/// become true at any time (from a signal handler): rendering then ends within about a tile, with what is
/// there.
void render(const RenderJob& job, RenderState& state, const std::atomic<bool>& stop,
            RenderCallbacks callbacks = {});

/// The same from the beginning.
RenderResult render(const Scene& scene, const Camera& camera, const Integrator& integrator,
                    const RenderSettings& settings, const std::atomic<bool>& stop,
                    RenderCallbacks callbacks = {});

}  // namespace vernier
