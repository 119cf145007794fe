#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/image/film.h"
#include "integrators/integrator.h"

namespace vernier {

class Camera;
class Scene;

/// Pixels [x, x + width) x [y, y + height) of the full picture.
struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
};

struct RenderOptions {
  int width = 0, height = 0;  ///< of the full picture
  Crop crop;                  ///< what is rendered; zero width: everything
  int spp = 64;               ///< samples a pixel; 0: until time_limit or a stop
  double time_limit = std::numeric_limits<double>::infinity();  ///< seconds of rendering
  uint64_t seed = 0;
};

/// State after some tiles; handed to the observer a few times a second at most, on the calling thread's
/// behalf and never concurrently.
struct RenderProgress {
  double seconds = 0;
  double fraction = 0;  ///< of the samples or of the time asked for, whichever is further; in [0, 1]
  double samples_per_pixel = 0;
  uint64_t samples = 0;  ///< camera samples in total
  RayCounts rays;
};

/// A sample that was not finite or was negative, so that it can be replayed. x, y are in the full picture.
struct BadSample {
  int x = 0, y = 0;
  uint32_t index = 0;
};

enum class StopReason { samples, time, interrupted };

struct RenderResult {
  Film film;  ///< of the crop's size
  StopReason reason = StopReason::samples;
  double seconds = 0;
  uint64_t samples = 0;
  RayCounts rays;
  uint64_t bad_samples = 0;                    ///< rejected by the film
  std::vector<BadSample> bad_sample_examples;  ///< at most a few
};

/// Renders tiles of the picture in passes on all threads. The same bytes for any number of threads. `stop`
/// may become true at any time (from a signal handler): rendering then ends within about a tile, with what is
/// there.
RenderResult render(const Scene& scene, const Camera& camera, const Integrator& integrator,
                    const RenderOptions& options, const std::atomic<bool>& stop,
                    const std::function<void(const RenderProgress&)>& observe = {});

}  // namespace vernier
