// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/render.h"

#include <algorithm>
#include <chrono>
#include <mutex>

#include "core/base/parallel.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/camera_sample.h"
#include "integrators/render/error_goal.h"
#include "integrators/render/gradients.h"
#include "integrators/render/light_pass.h"
#include "integrators/render/observer_thread.h"
#include "integrators/render/render_state.h"
#include "scene/scene.h"

namespace vernier {
namespace {

constexpr int tile_size = RenderState::tile_size;
constexpr size_t kept_bad_samples = 8;

/// Of the pass after `done` samples a pixel. Passes double at first, so that a picture comes soon and
/// stratified sets of samples are completed; later ones are short enough to look often at clock and target,
/// long enough that planning them costs nothing.
uint32_t pass_size(uint32_t done) { return std::clamp(done, 2u, std::clamp(done / 4, pilot, 1u << 14)); }

/// Keeps those that come first in the picture, whatever the order in which they are found.
void keep_few(std::vector<BadSample>& examples) {
  std::sort(examples.begin(), examples.end());
  if (examples.size() > kept_bad_samples) examples.resize(kept_bad_samples);
}

/// One render call. Tiles write disjoint pixels of the film; totals are merged once a tile.
class Renderer {
 public:
  Renderer(const RenderJob& job, RenderState& state, const std::atomic<bool>& stop, RenderCallbacks callbacks)
      : scene_(job.scene),
        camera_samples_(job.camera, job.scene, job.settings),
        integrator_(job.integrator),
        options_(job.settings),
        backdrop_(job.backdrop),
        sorter_(job.sorter.is_empty() ? nullptr : &job.sorter),
        chains_(job.light_paths ? job.light_paths->chains() : nullptr),
        small_lamps_(job.light_paths ? job.light_paths->small_lamps() : nullptr),
        crop_(rendered_part(job.settings)),
        stop_(stop),
        callbacks_(std::move(callbacks)),
        state_(state),
        seconds_before_(state_.partial.seconds) {
    if (!job.light_paths) return;
    light_pass_.emplace(*job.light_paths, sorter_);
    result().light_path_kind = job.light_paths->kind();
  }

  void run() {
    save_.next = seconds() + save_.interval;
    preview_.next = seconds() + preview_.interval;
    if (state_.partial.samples > 0) check_limits();
    while (!reason_) {
      if (state_.pass.size() == 0) plan_pass();
      render_pass();
      if (is_pass_complete()) end_pass();
      check_limits();
    }
    if (save_.act) take(save_);
    finish();
  }

 private:
  /// What one tile adds to the totals.
  struct Totals {
    uint64_t samples = 0;
    RayCounts rays;
    TileLight light;
    uint64_t bad_samples = 0;
    std::vector<BadSample> bad_sample_examples;
  };

  /// Something that is done with the state now and then, while nothing is rendered.
  struct Pause {
    const std::function<void(const RenderState&)>& act;
    const double interval;
    double next = 0;                    ///< when, in seconds of rendering
    std::atomic<bool> is_news = false;  ///< whether something has been rendered since the last one
  };

  RenderResult& result() { return state_.partial; }
  const RenderResult& result() const { return state_.partial; }
  double samples_per_pixel() const { return double(result().samples) / (double(crop_.width) * crop_.height); }
  double seconds() const {
    const std::chrono::duration<double> running = std::chrono::steady_clock::now() - start_;
    return seconds_before_ + running.count() - paused_;
  }
  bool out_of_time() const { return seconds() >= options_.limits.seconds; }

  /// Without regard to --spp, which may end the render in the midst of a pass.
  void plan_pass() {
    const uint32_t size = pass_size(state_.completed_spp);
    const bool may_adapt = options_.adaptive && state_.completed_spp >= pilot;
    state_.pass = may_adapt ? SamplePlan::adaptive(state_.drawn, state_.guides, size)
                            : SamplePlan::uniform(state_.drawn, size);
    state_.tile_progress.assign(size_t(state_.tile_count()), 0);
  }

  /// How much of the pass is wanted, in samples a pixel.
  uint32_t wanted_part() const {
    if (options_.limits.spp <= 0) return state_.pass.size();
    return std::min(state_.pass.size(),
                    uint32_t(std::max(0, options_.limits.spp - int(state_.completed_spp))));
  }
  /// Batches of light paths that go with the samples of complete passes and that part of the next.
  uint64_t light_batches(uint32_t part) const {
    return light_pass_ ? light_pass_->batches(state_.completed_spp + part) : 0;
  }
  bool is_pass_complete() const {
    if (state_.light_batches < light_batches(state_.pass.size())) return false;
    return std::all_of(state_.tile_progress.begin(), state_.tile_progress.end(),
                       [this](uint32_t part) { return part == state_.pass.size(); });
  }
  void end_pass() {
    // The first picture of all pixels is worth having at once.
    if (state_.completed_spp == 0 && std::isfinite(preview_.interval)) preview_.next = seconds();
    state_.completed_spp += state_.pass.size();
    for (int half = 0; half < Film::halves; ++half)
      state_.drawn.guiding[size_t(half)] += state_.pass.guiding_count(half);
    state_.pass = {};
    state_.tile_progress.clear();
  }
  bool has_all_samples() const {
    if (options_.limits.spp <= 0 || state_.light_batches < light_batches(wanted_part())) return false;
    return std::all_of(state_.tile_progress.begin(), state_.tile_progress.end(),
                       [wanted = wanted_part()](uint32_t part) { return part >= wanted; }) &&
           state_.completed_spp + wanted_part() >= uint32_t(options_.limits.spp);
  }

  /// Is it enough? The error counts between passes only, for a render that was cut must not end elsewhere.
  void check_limits() {
    if (has_all_samples()) {
      reason_ = StopReason::samples;
    } else if (stop_) {
      reason_ = StopReason::interrupted;
    } else if (out_of_time()) {
      reason_ = StopReason::time;
    }
    const bool has_target = options_.limits.error > 0;
    // The estimate costs as much as a few samples; without a target, looking when samples have grown by a
    // half is often enough.
    const bool due = has_target || 2 * state_.completed_spp >= 3 * state_.last_checked_spp;
    if (state_.pass.size() == 0 && state_.completed_spp >= pilot &&
        state_.completed_spp > state_.last_checked_spp && due) {
      state_.last_checked_spp = state_.completed_spp;
      result().convergence.push_back({seconds(), samples_per_pixel(), estimate_error(state_)});
    }
    if (!reason_ && has_target && !result().convergence.empty() &&
        error_ratio(result().convergence.back().error, options_.limits.error) <= 1)
      reason_ = StopReason::error;
  }

  void finish() {
    result().reason = *reason_;
    const auto& looks = result().convergence;
    const bool looked = !looks.empty() && looks.back().samples_per_pixel == samples_per_pixel();
    result().error = looked ? looks.back().error : estimate_error(state_);
    if (!looked && state_.completed_spp >= pilot)
      result().convergence.push_back({seconds(), samples_per_pixel(), result().error});
    result().missing = estimate_missing(state_.light, result().film);
    result().seconds = seconds();
  }

  /// As far as limits allow.
  void render_pass() {
    const uint32_t wanted = wanted_part();
    do {
      if (is_pause_due()) take_pauses();
      parallel_for(size_t(state_.tile_count()), [&](size_t tile) {
        // Every pixel gets its first samples unless interrupted.
        if (stop_ || (state_.completed_spp > 0 && out_of_time()) || is_pause_due()) return;
        uint32_t& part = state_.tile_progress[tile];
        if (part < wanted) render_tile(int(tile), part, wanted);
        part = std::max(part, wanted);
      });
      trace_light(light_batches(wanted));
    } while (is_pause_due() && !stop_);
  }

  /// Light paths of the samples that there are now.
  void trace_light(uint64_t wanted) {
    while (state_.light_batches < wanted && !stop_ && !(state_.completed_spp > 0 && out_of_time()) &&
           !is_pause_due()) {
      light_pass_->advance(state_, wanted);
      save_.is_news = preview_.is_news = true;
      if (observer_.is_due(seconds())) observer_.post(progress());
    }
  }

  /// From `part` of the pass to `wanted`.
  void render_tile(int tile, uint32_t part, uint32_t wanted) {
    Totals totals;
    const int columns = state_.tile_columns();
    const int x0 = tile % columns * tile_size, y0 = tile / columns * tile_size;
    for (int y = y0; y < std::min(y0 + tile_size, crop_.height); ++y)
      for (int x = x0; x < std::min(x0 + tile_size, crop_.width); ++x)
        for (int half = 0; half < Film::halves; ++half) {
          const uint32_t end = state_.pass.count(x, y, half, wanted);
          for (uint32_t i = state_.pass.count(x, y, half, part); i < end; ++i)
            render_sample({x, y, half, i}, totals);
        }
    state_.light[size_t(tile)] += totals.light;
    merge(totals);
  }

  bool is_due(const Pause& pause, bool now) const {
    return pause.act && pause.is_news && (now || seconds() >= pause.next);
  }
  bool is_pause_due() const {
    const bool now = callbacks_.now && *callbacks_.now;
    return is_due(save_, now) || is_due(preview_, now);
  }

  void take_pauses() {
    const bool now = callbacks_.now && callbacks_.now->exchange(false);
    if (is_due(save_, now)) take(save_);
    if (!is_due(preview_, now)) return;
    result().error = estimate_error(state_);
    take(preview_);
  }

  /// The clock stands still meanwhile.
  void take(Pause& pause) {
    const double start = seconds();
    result().seconds = start;
    pause.act(state_);
    pause.is_news = false;
    const double duration = seconds() - start;
    paused_ += duration;
    pause.next = start + (pause.interval > 0 ? std::max(pause.interval, 20 * duration) : 0);
  }

  /// A sample of the pass under way, by its place in the crop and its number in the plan.
  struct Planned {
    int x, y, half;
    uint32_t number;
  };

  void render_sample(const Planned& planned, Totals& totals) {
    const auto [x, y, half, number] = planned;
    const bool guides = number < state_.pass.guiding_count(half);
    const uint32_t index = draw_index(planned, guides);
    const int full_x = crop_.x + x, full_y = crop_.y + y;
    const CameraSampleId id{full_x, full_y, half, index};
    CameraSample sample = camera_samples_.get(id);
    std::optional<GradientSample> gradients;
    if (!state_.gradients.empty()) gradients = neighbors_of(id, camera_samples_, crop_);
    std::optional<LightParts> parts;
    if (sorter_) parts.emplace();
    const SampleContext context{spread(x, y, half), sorter_,     parts ? &*parts : nullptr,        chains_,
                                small_lamps_,       sample.cone, gradients ? &*gradients : nullptr};
    const Estimate estimate = integrator_.estimate(scene_, sample.ray, sample.sampler, context);
    ++totals.samples;
    totals.rays += estimate.rays;
    const FilmSample seen = backdrop_.behind(estimate, full_x, full_y);
    if ((gradients && !gradients->is_finite()) || !result().film.add(x, y, half, seen)) {
      ++totals.bad_samples;
      if (totals.bad_sample_examples.size() >= 8 * kept_bad_samples) keep_few(totals.bad_sample_examples);
      totals.bad_sample_examples.push_back({full_x, full_y, half, index});
      return;
    }
    if (gradients) state_.gradients.add(x, y, half, gradients->primal_only, gradients->differences);
    if (guides) {
      totals.light.add(estimate);
      if (options_.adaptive) state_.guides[size_t(half)].add(x, y, seen.radiance);
    }
    if (parts) add_parts(planned, *parts, max(seen.radiance - estimate.radiance, Rgb(0, 0, 0)));
  }

  /// What shows behind the scene is a part too.
  void add_parts(const Planned& planned, LightParts& parts, const Rgb& behind) {
    sorter_->add(parts, behind, LightRoute(), LightSource());
    for (size_t i = 0; i < result().light.size(); ++i)
      // Parts of what the film takes are finite and not negative, but for rounding at the end of the range.
      (void)result().light[i].film.add(planned.x, planned.y, planned.half, sorter_->part(parts, i));
  }

  /// Of a pixel's samples, as far as a half knows it: not by extra samples, whose number depends on the other
  /// half. Without guides it is unknown, and then no sample depends on what lies behind the scene.
  float spread(int x, int y, int half) const {
    return options_.adaptive ? state_.guides[size_t(half)].spread(x, y) : 0;
  }

  /// Index of the next sample of its kind, which goes on even where the film rejects one.
  uint32_t draw_index(const Planned& planned, bool guides) {
    const auto [x, y, half, number] = planned;
    if (guides) {
      const uint32_t n = state_.drawn.guiding[size_t(half)] + number;
      return options_.adaptive ? guiding_index(n) : n;
    }
    return extra_index(state_.drawn.extra[(size_t(y) * crop_.width + x) * Film::halves + size_t(half)]++);
  }

  void merge(const Totals& totals) {
    const std::lock_guard lock(mutex_);
    save_.is_news = preview_.is_news = true;
    result().samples += totals.samples;
    result().rays += totals.rays;
    result().bad_samples += totals.bad_samples;
    auto& examples = result().bad_sample_examples;
    examples.insert(examples.end(), totals.bad_sample_examples.begin(), totals.bad_sample_examples.end());
    keep_few(examples);
    if (observer_.is_due(seconds())) observer_.post(progress());
  }

  RenderProgress progress() const {
    RenderProgress p;
    p.seconds = seconds();
    p.samples = result().samples;
    p.samples_per_pixel = samples_per_pixel();
    p.rays = result().rays;
    if (!result().convergence.empty()) p.error = result().convergence.back().error;
    p.fraction = p.seconds / options_.limits.seconds;
    if (options_.limits.spp > 0) p.fraction = std::max(p.fraction, p.samples_per_pixel / options_.limits.spp);
    if (options_.limits.error > 0 && !result().convergence.empty()) {
      // Squared error falls as one over the samples, and is looked at where a pass ends.
      const auto& last = result().convergence.back();
      const double needed = last.samples_per_pixel * square(error_ratio(last.error, options_.limits.error));
      double end = state_.completed_spp + state_.pass.size();
      while (end < needed && end < 1e9) end += pass_size(uint32_t(end));
      p.fraction = std::max(p.fraction, p.samples_per_pixel / end);
    }
    p.fraction = std::min(1.0, p.fraction);
    return p;
  }

  const Scene& scene_;
  const CameraSamples camera_samples_;
  const Integrator& integrator_;
  const RenderSettings& options_;
  const Backdrop& backdrop_;
  const LightSorter* sorter_;  ///< null: no light is kept apart
  const SpecularChains* chains_;
  const SmallLamps* small_lamps_;
  std::optional<LightPass> light_pass_;
  const Crop crop_;
  const std::atomic<bool>& stop_;
  const RenderCallbacks callbacks_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  RenderState& state_;
  const double seconds_before_;  ///< of rendering, by those who did what state_ began with
  Pause save_{callbacks_.on_checkpoint, callbacks_.checkpoint_interval},
      preview_{callbacks_.on_preview, callbacks_.preview_interval};
  double paused_ = 0;  ///< seconds taken by them, in which nothing was rendered
  std::optional<StopReason> reason_;
  std::mutex mutex_;
  ObserverThread observer_{callbacks_.on_progress};
};

}  // namespace

Crop rendered_part(const RenderSettings& settings) {
  return settings.crop.width > 0 ? settings.crop : Crop{0, 0, settings.width, settings.height};
}

void render(const RenderJob& job, RenderState& state, const std::atomic<bool>& stop,
            RenderCallbacks callbacks) {
  Renderer(job, state, stop, std::move(callbacks)).run();
}

RenderResult render(const Scene& scene, const Camera& camera, const Integrator& integrator,
                    const RenderSettings& settings, const std::atomic<bool>& stop,
                    RenderCallbacks callbacks) {
  check_gradients(integrator, scene, settings);
  const Crop part = rendered_part(settings);
  const Backdrop backdrop(settings);
  const LightSorter sorter(settings.light_split, scene);
  const auto light_paths = light_paths_of(scene, camera, integrator, settings, sorter);
  RenderState state(part.width, part.height, settings.adaptive, backdrop.is_transparent(), sorter.layers(),
                    light_paths.has_value(), integrator.wants_gradients());
  render({scene, camera, integrator, settings, backdrop, sorter, light_paths ? &*light_paths : nullptr},
         state, stop, std::move(callbacks));
  return std::move(state.partial);
}

}  // namespace vernier
