// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/vernier/messages.h"

namespace vernier::apps {
namespace {

constexpr double seconds_between_lines = 10;

/// Seconds still to go if the rest takes as long as what is done; empty when too little is done to say.
std::optional<double> time_left(const RenderProgress& progress) {
  if (!(progress.fraction > 0.001) || progress.seconds <= 0) return {};
  return progress.seconds * (1 - progress.fraction) / progress.fraction;
}

/// "37.5 of 64 spp, 1.92 Msamples/s, 12.1 s left"
std::string describe(const RenderProgress& progress, int spp, const PlaceInRun& place) {
  std::string text =
      fmt::format("{:.{}f}", progress.samples_per_pixel, progress.samples_per_pixel < 10 ? 1 : 0);
  if (spp > 0) text += fmt::format(" of {}", spp);
  text += " spp";
  if (progress.seconds > 0)
    text += fmt::format(", {}samples/s", format_count(double(progress.samples) / progress.seconds));
  if (progress.error) text += fmt::format(", error {:.3g} %", 100 * progress.error->rel_rmse);
  if (const auto left = time_left(progress)) text += fmt::format(", {} left", format_seconds(*left));
  if (place.pictures == 1) return text;
  text += fmt::format("; picture {} of {}", place.picture, place.pictures);
  if (const auto left = place.time_left(progress.fraction))
    text += fmt::format(", {} left in all", format_seconds(*left));
  return text;
}

void draw_bar(double fraction, const std::string& text) {
  winsize window{};
  const int columns =
      ioctl(STDERR_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_col > 0 ? window.ws_col : 80;
  const int width = std::clamp(columns - static_cast<int>(text.size()) - 10, 0, 40);
  const int filled = static_cast<int>(std::lround(fraction * width));
  const std::string bar =
      std::string(static_cast<size_t>(filled), '#') + std::string(static_cast<size_t>(width - filled), '.');
  const std::string line = fmt::format("[{}] {:3.0f} % {}", bar, fraction * 100, text);
  // Return, the line cut to the window, erase the rest of it.
  fmt::print(stderr, "\r{}\x1b[K", line.substr(0, static_cast<size_t>(std::max(columns - 1, 1))));
  std::fflush(stderr);
}

void print_json(const RenderProgress& progress, const PlaceInRun& place) {
  nlohmann::ordered_json event = {
      {"event", "progress"},
      {"fraction", progress.fraction},
      {"seconds", progress.seconds},
      {"samples_per_pixel", progress.samples_per_pixel},
      {"samples", progress.samples},
      {"rays", progress.rays.camera + progress.rays.bounce + progress.rays.shadow}};
  if (progress.error) add_error(event, *progress.error);
  if (const auto left = time_left(progress)) event["seconds_left"] = *left;
  event["picture"] = place.picture;
  event["pictures"] = place.pictures;
  if (const auto left = place.time_left(progress.fraction)) event["seconds_left_in_all"] = *left;
  print_event(event);
}

}  // namespace

void add_error(nlohmann::ordered_json& event, const ErrorEstimate& error) {
  if (!std::isfinite(error.rel_rmse)) return;
  event["rel_rmse"] = error.rel_rmse;
  event["low"] = error.low;
  event["high"] = error.high;
}

std::optional<double> PlaceInRun::time_left(double fraction) const {
  const double done = double(rendered) + fraction, left = double(pictures - picture) + 1 - fraction;
  if (!(done > 0.001) || seconds <= 0) return {};
  return seconds * left / done;
}

ProgressReporter::ProgressReporter(ProgressMode mode, const RenderSettings& options, const PlaceInRun& place)
    : mode_(mode), spp_(options.limits.spp), place_(place) {
  if (mode_ == ProgressMode::automatic)
    mode_ = isatty(STDERR_FILENO) ? ProgressMode::bar : ProgressMode::lines;
}

void ProgressReporter::update(const RenderProgress& progress) {
  PlaceInRun place = place_;
  place.seconds += progress.seconds;
  switch (mode_) {
    case ProgressMode::bar:
      draw_bar(progress.fraction, describe(progress, spp_, place));
      bar_drawn_ = true;
      break;
    case ProgressMode::json:
      print_json(progress, place);
      break;
    case ProgressMode::lines:
      if (progress.seconds - last_line_ < seconds_between_lines) break;
      last_line_ = progress.seconds;
      fmt::print(stderr, "rendering: {:.0f} %, {}\n", progress.fraction * 100,
                 describe(progress, spp_, place));
      break;
    case ProgressMode::automatic:
    case ProgressMode::none:
      break;
  }
}

void ProgressReporter::finish() {
  if (bar_drawn_) fmt::print(stderr, "\n");
  bar_drawn_ = false;
}

}  // namespace vernier::apps
