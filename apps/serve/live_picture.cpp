// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/live_picture.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/vernier/missing_text.h"
#include "apps/vernier/render_report.h"
#include "core/film/error_estimate.h"
#include "integrators/render/picture.h"

namespace vernier::apps {
namespace {

constexpr int first_samples = 2;       // a pixel: one of each half
constexpr int samples_at_a_time = 16;  // a pixel; more would keep a tile, and so a new view, too long
constexpr double first_seconds = 0.045;
constexpr double preview_seconds = 0.4;
constexpr double least_seconds_between = 0.1;  // pictures of one render
constexpr int samples_to_filter = 8;

/// Steps of the coarse pictures of a view: the first takes about `first_seconds`, each next one four times as
/// long.
std::vector<int> coarse_steps(const RenderSettings& settings, double speed) {
  const double samples = double(settings.width) * settings.height * first_samples;
  constexpr int largest = 16;
  int step = 1;
  while (step < largest && samples / (step * step) > speed * first_seconds) step *= 2;
  std::vector<int> steps;
  for (; step > 1; step /= 2) steps.push_back(step);
  return steps;
}

RenderSettings coarser(RenderSettings settings, int step) {
  settings.width = (settings.width + step - 1) / step;
  settings.height = (settings.height + step - 1) / step;
  settings.limits = {};
  settings.limits.spp = first_samples;
  return settings;
}

/// What samples depend on, as text.
std::string identity_of_samples(RenderSettings settings) {
  settings.limits = {};
  return settings.to_json();
}

std::vector<bool> covered_pixels(const Film& film) {
  std::vector<bool> covered;
  covered.reserve(size_t(film.width()) * size_t(film.height()));
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) covered.push_back(film.samples(x, y) > 0);
  return covered;
}

nlohmann::ordered_json to_json(const ErrorEstimate& error) {
  if (!std::isfinite(error.rel_rmse)) return nullptr;
  return {{"rel_rmse", error.rel_rmse},
          {"low", error.low},
          {"high", error.high},
          {"unreliable", error.unreliable}};
}

}  // namespace

void LivePicture::begin(const RenderRequest& request, uint64_t view, NoticeLog& log) {
  const RenderSettings settings = scene_.prepare(request, log);
  request_ = request;
  view_ = view;
  keep_or_restart(settings);
  if (!has_picture_)
    advance();
  else if (is_filtered())
    publish_filtered();
  else if (session_)
    publish_render();
  else
    publish_coarse();
}

/// A session whose samples are those of the new view has only its limits changed.
void LivePicture::keep_or_restart(const RenderSettings& settings) {
  const bool is_same =
      scene_version_ == scene_.version() && identity_of_samples(settings) == identity_of_samples(settings_);
  const RenderLimits &now = settings.limits, before = settings_.limits;
  settings_ = settings;
  if (is_same && (now.spp == 0 || now.spp >= wanted_)) {
    if (now.spp != before.spp || now.error != before.error) ended_by_.reset();
    return;
  }
  scene_version_ = scene_.version();
  session_.reset();
  filtered_.reset();
  has_picture_ = false;
  steps_ = coarse_steps(settings, speed_);
}

/// Views that follow each other quickly would otherwise keep each other from being seen.
const std::atomic<bool>& LivePicture::stop() const {
  static const std::atomic<bool> never{false};
  return has_picture_ ? stop_ : never;
}

void LivePicture::render_coarse() {
  RenderSession session(scene_.scene(), coarser(settings_, steps_.front()));
  if (session.run(stop()) == StopReason::interrupted) return;
  note_speed(session.result());
  coarse_ = color_and_alpha(session.picture()).image;
  coarse_step_ = steps_.front();
  steps_.erase(steps_.begin());
  publish_coarse();
}

void LivePicture::note_speed(const RenderResult& result) {
  if (result.seconds > 0) speed_ = double(result.samples) / result.seconds;
}

void LivePicture::publish_coarse() {
  Frame frame;
  frame.step = coarse_step_;
  frame.color = coarse_;
  publish(std::move(frame));
}

void LivePicture::start_session() {
  session_ = std::make_unique<RenderSession>(scene_.scene(), settings_);
  session_->on_preview(
      [this] {
        publish_render();
        if (!audience_.is_looking()) stop_ = true;
      },
      preview_seconds);
  ++render_;
  wanted_ = 0;
  is_step_done_ = true;
  published_ = 0;
  ended_by_.reset();
}

bool LivePicture::advance() {
  if (task_ && task_->is_done()) take_filtered();
  if (!steps_.empty()) {
    render_coarse();
    return true;
  }
  if (!session_) start_session();
  if (ended_by_) return false;
  render_on();
  return true;
}

void LivePicture::render_on() {
  const int asked = settings_.limits.spp;
  if (is_step_done_) wanted_ = std::max(first_samples, wanted_ + std::min(wanted_, samples_at_a_time));
  if (asked > 0) wanted_ = std::min(wanted_, asked);
  RenderLimits limits = settings_.limits;
  limits.spp = wanted_;
  session_->set_limits(limits);
  const StopReason reason = session_->run(stop());
  const RenderResult& result = session_->result();
  note_speed(result);
  is_step_done_ = reason != StopReason::interrupted;
  if (!is_step_done_) return;
  if (reason != StopReason::samples || wanted_ == asked) ended_by_ = reason;
  if (ended_by_ || wanted_ == first_samples || result.seconds - published_ > least_seconds_between)
    publish_render();
}

void LivePicture::publish_render() {
  const RenderResult& result = session_->result();
  const Film& film = result.film;
  published_ = result.seconds;
  start_filter_if_due();
  if (is_filtered()) {
    tell();
    return;
  }
  Frame frame;
  frame.color = color_and_alpha(session_->picture()).image;
  const std::vector<bool> covered = covered_pixels(film);
  if (std::find(covered.begin(), covered.end(), false) == covered.end())
    frame.error = error_layers(film).standard_error;
  else if (!coarse_.empty())
    fill_gaps(frame.color, coarse_, coarse_step_, covered);
  publish(std::move(frame));
}

/// At first soon, then whenever samples have doubled, and at the end.
void LivePicture::start_filter_if_due() {
  const double samples = session_->status().samples_per_pixel;
  if (!request_.denoiser || task_ || samples < std::min(samples_to_filter, std::max(1, settings_.limits.spp)))
    return;
  const bool is_due =
      !is_filtered() || samples >= 2 * filtered_->samples || (ended_by_ && samples > filtered_->samples);
  if (!is_due) return;
  task_render_ = render_;
  task_ = std::make_unique<DenoiseTask>(
      NoisyRender{scene_.scene(), settings_, RenderResult(session_->result().film), *request_.denoiser,
                  request_.layer_list, samples},
      scene_.mutex());
}

/// What was filtered may be of a view that has been left since, or no longer be asked for.
void LivePicture::take_filtered() {
  const std::unique_ptr<DenoiseTask> task = std::move(task_);
  Filtered filtered{task->samples(), task->take(), &task->denoiser()};
  if (task_render_ != render_ || !session_ || request_.denoiser != filtered.denoiser) return;
  filtered_ = std::move(filtered);
  publish_filtered();
  start_filter_if_due();
}

void LivePicture::publish_filtered() {
  Frame frame;
  frame.color = filtered_->denoised.picture;
  frame.error = filtered_->denoised.pixel_error;
  publish(std::move(frame));
}

void LivePicture::publish(Frame frame) {
  frame.view = view_;
  develop(frame, request_.display);
  {
    const std::lock_guard lock(frame_mutex_);
    frame.number = frame_ ? frame_->number + 1 : 1;
    frame_ = std::make_shared<const Frame>(std::move(frame));
  }
  has_picture_ = true;
  audience_.note_picture();
  tell();
}

void LivePicture::tell() {
  nlohmann::ordered_json json{{"frame", frame_->number},    {"view", frame_->view},
                              {"step", frame_->step},       {"width", settings_.width},
                              {"height", settings_.height}, {"has_error", frame_->error.has_value()}};
  if (session_ && frame_->step == 1) {
    const RenderStatus status = session_->status();
    json["samples"] = status.samples_per_pixel;
    json["seconds"] = status.seconds;
    json["error"] = to_json(status.error);
    json["missing"] = missing_text(status.missing);
  }
  if (ended_by_) json["ended_by"] = name_of(*ended_by_);
  if (is_filtered() && frame_->step == 1) {
    json["denoised"] = denoised_json(*filtered_->denoiser, filtered_->denoised.error);
    json["denoised"]["samples"] = filtered_->samples;
  }
  audience_.tell("picture", json.dump());
}

std::shared_ptr<const Frame> LivePicture::frame() const {
  const std::lock_guard lock(frame_mutex_);
  return frame_;
}

}  // namespace vernier::apps
