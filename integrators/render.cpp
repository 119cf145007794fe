#include "integrators/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <mutex>

#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier {
namespace {

constexpr int tile_size = 16;
constexpr int largest_pass = 16;  // samples a pixel between looks at clock and target
constexpr size_t kept_bad_samples = 8;
constexpr double report_interval = 0.2;  // seconds

/// One render call's state. Tiles write disjoint pixels of the film; totals are merged once a tile.
class Renderer {
 public:
  Renderer(const Scene& scene, const Camera& camera, const Integrator& integrator,
           const RenderOptions& options, const std::atomic<bool>& stop,
           const std::function<void(const RenderProgress&)>& observe)
      : scene_(scene),
        camera_(camera),
        integrator_(integrator),
        options_(options),
        crop_(options.crop.width > 0 ? options.crop : Crop{0, 0, options.width, options.height}),
        stop_(stop),
        observe_(observe),
        result_{Film(crop_.width, crop_.height), StopReason::samples, 0, 0, {}, 0, {}} {}

  RenderResult run() {
    int64_t done = 0;
    while (options_.spp == 0 || done < options_.spp) {
      // Passes double, so that a first picture comes soon and each end is a stratified set of samples.
      int64_t pass = std::clamp<int64_t>(done, 1, largest_pass);
      if (options_.spp > 0) pass = std::min<int64_t>(pass, options_.spp - done);
      render_pass(done, pass);
      if (stop_ || (done > 0 && out_of_time())) break;
      done += pass;
      // Time counts from the second pass on: the first always completes, so that every pixel has a sample.
      if (out_of_time()) break;
    }
    if (stop_)
      result_.reason = StopReason::interrupted;
    else if (options_.spp == 0 || done < options_.spp)
      result_.reason = StopReason::time;
    result_.seconds = seconds();
    std::sort(result_.bad_sample_examples.begin(), result_.bad_sample_examples.end(),
              [](const auto& a, const auto& b) {
                return std::tie(a.index, a.y, a.x) < std::tie(b.index, b.y, b.x);
              });
    return std::move(result_);
  }

 private:
  /// What one tile adds to the totals.
  struct Totals {
    uint64_t samples = 0;
    RayCounts rays;
    std::vector<BadSample> bad;
  };

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  bool out_of_time() const { return seconds() >= options_.time_limit; }

  void render_pass(int64_t first, int64_t count) {
    const int columns = (crop_.width + tile_size - 1) / tile_size;
    const int rows = (crop_.height + tile_size - 1) / tile_size;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
      if (stop_ || (first > 0 && out_of_time())) return;
      Totals totals;
      const int x0 = tile % columns * tile_size, y0 = tile / columns * tile_size;
      for (int y = y0; y < std::min(y0 + tile_size, crop_.height); ++y)
        for (int x = x0; x < std::min(x0 + tile_size, crop_.width); ++x)
          for (int64_t index = first; index < first + count; ++index)
            render_sample(x, y, uint32_t(index), totals);
      merge(totals);
    });
  }

  void render_sample(int x, int y, uint32_t index, Totals& totals) {
    const int full_x = crop_.x + x, full_y = crop_.y + y;
    Sampler sampler(uint32_t(full_y) * uint32_t(options_.width) + uint32_t(full_x), index, options_.seed);
    const Vec2f in_pixel = sampler.next2();
    const Ray ray = camera_.ray({float(full_x) + in_pixel.x, float(full_y) + in_pixel.y});
    const Estimate estimate = integrator_.estimate(scene_, ray, sampler);
    ++totals.samples;
    totals.rays += estimate.rays;
    if (!result_.film.add(x, y, 0, estimate.radiance)) totals.bad.push_back({full_x, full_y, index});
  }

  void merge(const Totals& totals) {
    const std::lock_guard lock(mutex_);
    result_.samples += totals.samples;
    result_.rays += totals.rays;
    result_.bad_samples += totals.bad.size();
    for (const auto& bad : totals.bad)
      if (result_.bad_sample_examples.size() < kept_bad_samples) result_.bad_sample_examples.push_back(bad);
    if (observe_ && seconds() - reported_ >= report_interval) {
      reported_ = seconds();
      observe_(progress());
    }
  }

  RenderProgress progress() const {
    RenderProgress p;
    p.seconds = seconds();
    p.samples = result_.samples;
    p.samples_per_pixel = double(result_.samples) / (double(crop_.width) * crop_.height);
    p.fraction = std::min(1.0, p.seconds / options_.time_limit);
    if (options_.spp > 0) p.fraction = std::max(p.fraction, p.samples_per_pixel / options_.spp);
    p.rays = result_.rays;
    return p;
  }

  const Scene& scene_;
  const Camera& camera_;
  const Integrator& integrator_;
  const RenderOptions& options_;
  const Crop crop_;
  const std::atomic<bool>& stop_;
  const std::function<void(const RenderProgress&)>& observe_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double reported_ = 0;
  std::mutex mutex_;
  RenderResult result_;
};

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Integrator& integrator,
                    const RenderOptions& options, const std::atomic<bool>& stop,
                    const std::function<void(const RenderProgress&)>& observe) {
  return Renderer(scene, camera, integrator, options, stop, observe).run();
}

}  // namespace vernier
