// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/report/report_page.h"
#include "apps/vernier/checkpointing.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/denoising.h"
#include "apps/vernier/missing_text.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/outputs.h"
#include "apps/vernier/progress.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "apps/vernier/scene_summary.h"
#include "apps/vernier/stop_signals.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/display/display.h"
#include "core/image/image_io.h"
#include "integrators/render/visible_light.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "vernier/ground.h"

namespace vernier::apps {
namespace {

class Stopwatch {
 public:
  /// Seconds since the last call, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - last_;
    last_ = now;
    return elapsed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

void warn_of_bad_samples(const RenderResult& result, const RenderFlags& flags, NoticeLog& log) {
  if (result.bad_samples == 0) return;
  std::string replay;
  if (!result.bad_sample_examples.empty()) {
    const BadSample& first = result.bad_sample_examples.front();
    replay = fmt::format(
        "; pixel {},{} has one, and the same command with --crop 1x1+{}+{} --spp {} --adaptive off --seed {} "
        "replays it",
        first.x, first.y, first.x, first.y, 2 * (first.index + 1), flags.seed);
  }
  log.add({Notice::Severity::warning,
           {},
           fmt::format("{} of {} samples were not finite or were negative, and were left out{}",
                       result.bad_samples, result.samples, replay)});
}

/// raycast's pictures are data; surroundings play no part in them.
bool shows_light(const RenderFlags& flags) { return flags.integrator != "raycast"; }

/// Says so when what the camera sees of the scene comes out all but black, and what helps.
void warn_if_black(double mean, const RenderFlags& flags, const RenderReport& report, NoticeLog& log) {
  constexpr double black = 0.005, grey = 0.18;
  if (mean * std::exp2(flags.display.exposure) >= black) return;
  std::vector<std::string> remedies;
  if (report.surroundings.name != "studio") remedies.emplace_back("--env studio lights it");
  if (mean > 0)
    remedies.push_back(
        fmt::format("--exposure {:.0f} brightens a .png or .jpg", std::ceil(std::log2(grey / mean))));
  log.add({Notice::Severity::warning,
           {},
           fmt::format("the picture is almost all black, its mean luminance {:.2g}{}{}", mean,
                       remedies.empty() ? "" : "; ", fmt::join(remedies, ", "))});
}

/// File names and arguments need not be UTF-8, which JSON is.
std::string to_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// Replaces the colour of `picture`, its first three channels, when a filter was asked for.
std::optional<Denoised> denoise_if_asked(const RenderRequest& request, LayeredImage& picture,
                                         Metadata& metadata) {
  if (!request.denoiser) return std::nullopt;
  Denoised denoised = denoise(picture, *request.denoiser);
  put_into(picture, denoised);
  metadata.merge(denoised_metadata(*request.denoiser, denoised.error));
  return denoised;
}

/// The scene to render, and what the report says of it.
SceneDescription load_scene(const RenderRequest& request, RenderReport& report, NoticeLog& log) {
  const RenderFlags& flags = request.flags;
  SceneDescription description = import_scene(flags.scene, flags.import);
  replace_surroundings(description, request.surroundings, log);
  report.scene_file = flags.scene;
  report.scene_hash = description.hash;
  report.counts = count(description);
  if (flags.background.ground == "matte") add_ground(description);
  return description;
}

/// Renders, and says on the way how far it is.
void run(RenderSession& session, const RenderRequest& request) {
  const StopSignals signals;
  ProgressReporter progress(request.progress, session.settings());
  session.on_progress([&](const RenderProgress& state) { progress.update(state); });
  session.run(signals.stop());
}

/// The scene as it is rendered, with its camera and size in `settings`.
std::shared_ptr<const Scene> prepare(const RenderRequest& request, RenderSettings& settings,
                                     RenderReport& report, NoticeLog& log) {
  const RenderFlags& flags = request.flags;
  Stopwatch watch;
  SceneDescription description = load_scene(request, report, log);
  log.add(description.notices);
  const auto chosen = choose_camera(description.cameras, flags.camera, log);
  report.load_seconds = watch.lap();
  const std::shared_ptr<Scene> scene = build_scene(std::move(description), {flags.accelerator});
  report.accelerator = scene->accelerator_name();
  report.accelerator_stats = scene->accelerator().stats();
  report.build_seconds = watch.lap();

  settings.camera = place_camera(chosen, flags.camera, scene->geometry(), asked_aspect(flags.size), log);
  report.camera = settings.camera.name;
  fill_in_size(settings, settings.camera);
  check_picture_size(settings, memory_use(request));
  if (shows_light(flags))
    report.surroundings = surround(*scene, request.surroundings, settings.camera, settings, log);
  log.add(scene->notices());
  if (flags.import.strict) refuse_warnings(flags.scene, scene->notices());
  return scene;
}

void warn_of_result(const RenderResult& result, const Scene& scene, const RenderFlags& flags,
                    const RenderReport& report, NoticeLog& log) {
  warn_of_bad_samples(result, flags, log);
  warn_of_missing_light(result, flags.integrator_options.max_depth, log);
  if (!shows_light(flags)) return;
  const RenderSettings& settings = report.settings;
  const Camera camera(settings.camera, settings.width, settings.height);
  warn_if_black(covered_luminance(result.film, scene, camera, settings), flags, report, log);
}

ExitCode run_render(const RenderFlags& flags, const std::string& command_line) {
  if (print_requested_list(flags)) return ExitCode::done;
  const ThreadLimit threads(flags.threads);
  Stopwatch watch;
  const RenderRequest request = check_render_flags(flags);
  NoticeLog log(flags.quiet);
  Checkpointing checkpointing(flags, log);
  RenderReport report;
  report.command_line = command_line;
  report.threads = thread_count();
  const double check_seconds = watch.lap();
  RenderSettings settings = request.settings;
  const std::shared_ptr<const Scene> scene = prepare(request, settings, report, log);
  report.load_seconds += check_seconds;
  RenderSession session(scene, std::move(settings));
  report.settings = session.settings();
  checkpointing.attach(session);
  if (flags.verbose) fmt::print(stderr, "{}", scene_lines(report));

  run(session, request);
  const RenderResult& result = session.result();
  warn_of_result(result, *scene, flags, report, log);

  watch.lap();
  LayeredImage picture = session.picture(request.layer_list);
  Metadata metadata = image_metadata(report, flags, result);
  const auto denoised = denoise_if_asked(request, picture, metadata);
  Outputs outputs;
  for (const auto& path : flags.outputs)
    if (outputs.attempt([&] { write_picture(path, picture, metadata, request.display); }))
      report.files.push_back(path);
  report.output_seconds = watch.lap();
  auto stats = stats_json(report, flags, result, log);
  if (denoised) stats["denoised"] = denoised_json(*request.denoiser, denoised->error);
  checkpointing.add_to(stats);
  if (!flags.stats.empty()) outputs.attempt([&] { write_file(flags.stats, to_text(stats) + "\n"); });
  if (!flags.report.empty())
    outputs.attempt(
        [&] { write_file(flags.report, report_page(stats, result.film, denoised, request.display)); });
  if (!flags.quiet) fmt::print("{}\n", summary_line(report, result));
  if (!flags.quiet && denoised) fmt::print("{}\n", denoised_text(*request.denoiser, denoised->error));
  outputs.attempt([&] { checkpointing.require_written(); });
  if (outputs.have_failed()) return ExitCode::input;
  return result.reason == StopReason::interrupted ? ExitCode::stopped : ExitCode::done;
}

}  // namespace

void register_render(Program& program) {
  CLI::App* command = program.app.add_subcommand("render", "Render a glTF scene to pictures");
  auto flags = std::make_shared<RenderFlags>();
  add_render_flags(*command, *flags);
  add_checkpoint_flags(*command, *flags);
  command->footer("Example: vernier render scene.glb -o out.exr -o out.png --time 1m");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_render(*flags, program.command_line); };
  });
}

}  // namespace vernier::apps
