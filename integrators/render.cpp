#include "integrators/render.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>

#include "integrators/camera_sample.h"
#include "integrators/sample_plan.h"
#include "scene/scene.h"

namespace vernier {
namespace {

constexpr int tile_size = 16;
constexpr uint32_t pilot = 16;  // samples a pixel before any decision is taken
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
        guides_{SampleGuide(options.adaptive ? crop_.width : 0, crop_.height),
                SampleGuide(options.adaptive ? crop_.width : 0, crop_.height)},
        result_(Film(crop_.width, crop_.height)) {}

  RenderResult run() {
    uint32_t done = 0;
    while (!reason_) {
      const uint32_t count = next_pass(done);
      const bool may_adapt = options_.adaptive && done >= pilot;
      const SamplePlan plan = may_adapt ? SamplePlan::adaptive(result_.film, guides_, count)
                                        : SamplePlan::uniform(result_.film, count);
      render_pass(plan, done == 0);
      done += count;
      look(done);
    }
    result_.reason = *reason_;
    result_.error = estimate_error(result_.film);
    result_.seconds = seconds();
    std::sort(result_.bad_sample_examples.begin(), result_.bad_sample_examples.end());
    return std::move(result_);
  }

 private:
  /// What one tile adds to the totals.
  struct Totals {
    uint64_t samples = 0;
    RayCounts rays;
    std::vector<BadSample> bad;
  };

  /// Samples drawn so far: their index goes on even where the film rejects one.
  uint32_t& taken(int x, int y, int half) {
    return taken_[(size_t(y) * crop_.width + x) * Film::halves + size_t(half)];
  }
  double samples_per_pixel() const { return double(result_.samples) / (double(crop_.width) * crop_.height); }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  bool out_of_time() const { return seconds() >= options_.time_limit; }

  /// Passes double at first, so that a picture comes soon and stratified sets of samples are completed; later
  /// ones are short enough to look often at clock and target, long enough that planning them costs nothing.
  uint32_t next_pass(uint32_t done) const {
    const uint32_t count = std::clamp(done, 2u, std::max(pilot, done / 4));
    return options_.spp > 0 ? std::min(count, uint32_t(options_.spp) - done) : count;
  }

  /// Between passes: is it enough?
  void look(uint32_t done) {
    if (stop_) {
      reason_ = StopReason::interrupted;
    } else if (options_.spp > 0 && done >= uint32_t(options_.spp)) {
      reason_ = StopReason::samples;
    } else if (out_of_time()) {
      reason_ = StopReason::time;
    }
    // The estimate costs as much as a few samples; looking when samples have grown by a half is often enough.
    if (done < pilot || (double(done) < next_look_ && !reason_)) return;
    next_look_ = done * (options_.target_error > 0 ? 1.1 : 1.5);
    error_ = estimate_error(result_.film);
    result_.convergence.push_back({seconds(), samples_per_pixel(), *error_});
    if (!reason_ && options_.target_error > 0 && error_->rel_rmse <= options_.target_error)
      reason_ = StopReason::error;
  }

  void render_pass(const SamplePlan& plan, bool first) {
    const int columns = (crop_.width + tile_size - 1) / tile_size;
    const int rows = (crop_.height + tile_size - 1) / tile_size;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
      // The first pass always completes unless interrupted, so that every pixel has a sample.
      if (stop_ || (!first && out_of_time())) return;
      Totals totals;
      const int x0 = tile % columns * tile_size, y0 = tile / columns * tile_size;
      for (int y = y0; y < std::min(y0 + tile_size, crop_.height); ++y)
        for (int x = x0; x < std::min(x0 + tile_size, crop_.width); ++x)
          for (int half = 0; half < Film::halves; ++half)
            for (uint32_t i = 0; i < plan.count(x, y, half); ++i)
              render_sample(x, y, half, options_.adaptive && i < plan.even_count(half), totals);
      merge(totals);
    });
  }

  void render_sample(int x, int y, int half, bool guides, Totals& totals) {
    const int full_x = crop_.x + x, full_y = crop_.y + y;
    const uint32_t index = taken(x, y, half)++;
    CameraSample sample = camera_sample(camera_, options_.width, full_x, full_y, half, index, options_.seed);
    const Estimate estimate = integrator_.estimate(scene_, sample.ray, sample.sampler);
    ++totals.samples;
    totals.rays += estimate.rays;
    if (!result_.film.add(x, y, half, estimate.radiance))
      totals.bad.push_back({full_x, full_y, half, index});
    else if (guides)
      guides_[size_t(half)].add(x, y, estimate.radiance);
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
    p.samples_per_pixel = samples_per_pixel();
    p.rays = result_.rays;
    p.error = error_;
    p.fraction = p.seconds / options_.time_limit;
    if (options_.spp > 0) p.fraction = std::max(p.fraction, p.samples_per_pixel / options_.spp);
    if (options_.target_error > 0 && !result_.convergence.empty()) {
      // Squared error falls as one over the samples.
      const auto& last = result_.convergence.back();
      const double needed = last.samples_per_pixel * square(last.error.rel_rmse / options_.target_error);
      p.fraction = std::max(p.fraction, p.samples_per_pixel / needed);
    }
    p.fraction = std::min(1.0, p.fraction);
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
  double next_look_ = 0;
  std::optional<StopReason> reason_;
  std::optional<ErrorEstimate> error_;
  std::vector<uint32_t> taken_ = std::vector<uint32_t>(size_t(crop_.width) * crop_.height * Film::halves);
  std::mutex mutex_;
  std::array<SampleGuide, Film::halves> guides_;
  RenderResult result_;
};

}  // namespace

RenderResult render(const Scene& scene, const Camera& camera, const Integrator& integrator,
                    const RenderOptions& options, const std::atomic<bool>& stop,
                    const std::function<void(const RenderProgress&)>& observe) {
  return Renderer(scene, camera, integrator, options, stop, observe).run();
}

}  // namespace vernier
