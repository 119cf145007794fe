// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/report/report_page.h"
#include "apps/vernier/checkpointing.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/denoising.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/outputs.h"
#include "apps/vernier/partial_pictures.h"
#include "apps/vernier/picture_output.h"
#include "apps/vernier/result_warnings.h"
#include "apps/vernier/stop_signals.h"
#include "apps/vernier/stopwatch.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"

namespace vernier::apps {
namespace {

/// File names and arguments need not be UTF-8, which JSON is.
std::string to_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Replaces the colour of `picture`, its first three channels, when a filter was asked for.
std::optional<Denoised> denoise_if_asked(const RenderRequest& request, LayeredImage& picture,
                                         Metadata& metadata) {
  if (!request.denoiser) return std::nullopt;
  Denoised denoised = denoise(picture, *request.denoiser);
  replace_color(picture, denoised);
  metadata.merge(denoised_metadata(*request.denoiser, denoised.error));
  return denoised;
}

/// Renders, and says on the way how far it is.
void run(RenderSession& session, const RenderRequest& request, const PlaceInRun& place) {
  const StopSignals signals;
  ProgressReporter progress(request.progress, session.settings(), place);
  session.on_progress([&](const RenderProgress& state) { progress.update(state); });
  session.run(signals.stop());
}

/// The size of the picture and what is around the scene, for a picture by this camera.
void prepare(const RenderRequest& request, PosedScene& posed, const View& view, RenderReport& report,
             NoticeLog& log) {
  RenderSettings& settings = report.settings;
  settings = request.settings;
  settings.camera = view.camera;
  report.camera = view.camera.name;
  fill_in_size(settings, settings.camera);
  report.lens = fit_lens(settings, request.flags.camera.lens, *posed.scene(), log);
  check_picture_size(settings, memory_use(request), request.flags.import.memory);
  if (shows_light(request.flags)) report.surroundings = posed.set_environment(request, settings, view, log);
  log.add(posed.scene()->notices());
  if (request.flags.import.strict) refuse_warnings(request.flags.scene, posed.scene()->notices());
}

/// What a program that follows the render is told before it.
nlohmann::ordered_json rendering_event(const RenderReport& report, const RenderFlags& flags,
                                       const PlaceInRun& place) {
  const RenderSettings& settings = report.settings;
  return {{"event", "rendering"},          {"scene", flags.scene},      {"camera", report.camera},
          {"width", settings.width},       {"height", settings.height}, {"outputs", flags.outputs},
          {"asked", asked_json(settings)}, {"picture", place.picture},  {"pictures", place.pictures}};
}

nlohmann::ordered_json wrote_event(const std::string& path, const LayeredImage& picture,
                                   const RenderResult& result) {
  nlohmann::ordered_json event = {{"event", "wrote"}, {"file", path}};
  std::error_code unknown;
  if (const auto bytes = std::filesystem::file_size(path, unknown); !unknown) event["bytes"] = bytes;
  if (!is_display_file(path)) event["channels"] = picture.channel_names;
  event["samples_per_pixel"] = samples_per_pixel(result);
  add_error(event, result.error);
  return event;
}

/// The lines that say what was done. Standard output may be the picture's; standard error may be a
/// program's, which knows already.
void say(const RenderFlags& flags, const std::string& line) {
  const bool is_taken = std::any_of(flags.outputs.begin(), flags.outputs.end(), is_standard_stream);
  if (flags.quiet || (is_taken && speaks_json())) return;
  fmt::print(is_taken ? stderr : stdout, "{}\n", line);
  std::fflush(stdout);
}

}  // namespace

PictureOutcome render_picture(const RenderRequest& request, PosedScene& posed, const View& view,
                              const PictureContext& context, NoticeLog& log) {
  const RenderFlags& flags = request.flags;
  Checkpointing checkpointing(flags, log);
  RenderReport report = posed.report();
  report.command_line = context.command_line;
  report.picture_command = context.picture_command;
  report.threads = thread_count();
  if (flags.outputs.empty()) report.kept = flags.checkpoint;
  prepare(request, posed, view, report, log);
  RenderSession session(posed.scene(), report.settings);
  if (context.moments) session.set_moments(*context.moments);
  checkpointing.attach(session);
  PartialPictures partial(request, report, log);
  partial.attach(session, context.write_now);
  if (flags.verbose && !speaks_json()) fmt::print(stderr, "{}", scene_lines(report));
  print_event(rendering_event(report, flags, context.place));

  run(session, request, context.place);
  const RenderResult& result = session.result();
  if (report.settings.texture_filter.is_on()) report.texture_mip_bytes = posed.scene()->color_mips().bytes();
  warn_of_result(result, *posed.scene(), flags, report, log);

  Stopwatch watch;
  LayeredImage picture = session.picture(request.layer_list);
  Metadata metadata = image_metadata(report, flags, result);
  const auto denoised = denoise_if_asked(request, picture, metadata);
  if (const std::string warning = half_warning(flags.exr, picture); !warning.empty())
    log.add({Notice::Severity::warning, "--half", warning});
  Outputs outputs;
  for (const auto& path : flags.outputs)
    if (outputs.attempt([&] { write_output(path, picture, metadata, request); })) {
      report.files.push_back(path);
      print_event(wrote_event(path, picture, result));
    }
  report.output_seconds = watch.lap();
  auto stats = stats_json(report, flags, result, log);
  if (denoised) stats["denoised"] = denoised_json(*request.denoiser, denoised->error);
  checkpointing.add_to(stats);
  if (!flags.stats.empty()) outputs.attempt([&] { write_file(flags.stats, to_text(stats) + "\n"); });
  if (!flags.report.empty())
    outputs.attempt(
        [&] { write_file(flags.report, report_page(stats, result.film, denoised, request.display)); });
  say(flags, summary_line(report, result));
  if (denoised) say(flags, denoised_text(*request.denoiser, denoised->error));
  outputs.attempt([&] { checkpointing.require_written(); });
  const bool is_stopped = result.reason == StopReason::interrupted;
  if (outputs.have_failed()) return {ExitCode::input, is_stopped};
  if (!is_stopped) checkpointing.drop_if_asked();
  return {is_stopped ? ExitCode::stopped : ExitCode::done, is_stopped};
}

}  // namespace vernier::apps
