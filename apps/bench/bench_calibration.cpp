// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "apps/bench/bench.h"
#include "apps/bench/calibration.h"
#include "apps/vernier/flags.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct CalibrationFlags {
  RenderFlags render;  ///< scene, surroundings, size, how the picture is made
  int spp = 64, seeds = 20;
  std::string reference, json;
};

std::string figure(const Json& value) {
  return value.is_null() ? "-" : fmt::format("{:.3g}", value.get<double>());
}

void print_report(const Json& report) {
  std::vector<std::vector<std::string>> rows{{"nominal coverage"}, {"measured"}};
  for (const Json& row : report["coverage"]) {
    rows[0].push_back(fmt::format("{:.0f} %", 100 * row["nominal"].get<double>()));
    rows[1].push_back(
        row["measured"].is_null() ? "-" : fmt::format("{:.1f} %", 100 * row["measured"].get<double>()));
  }
  fmt::print("{}", text_table(rows));
  fmt::print("pixels not to be trusted  {:.1f} %\n", 100 * report["flagged"].get<double>());
  fmt::print("predicted over actual RMSE, by brightness, dark to bright ");
  for (const Json& decile : report["deciles"]) fmt::print(" {}", figure(decile["predicted_over_actual"]));
  const Json& image = report["image"];
  fmt::print(
      "\nimage: estimated {:.3g} %, true {:.3g} %, ratio {} ({} to {}) over {} runs of {:.4g} spp, of means "
      "{}\n",
      100 * image["estimated"].get<double>(), 100 * image["true"].get<double>(),
      figure(image["ratio"]["median"]), figure(image["ratio"]["low"]), figure(image["ratio"]["high"]),
      report["runs"].get<size_t>(), report["samples_per_pixel"].get<double>(),
      figure(image["ratio_of_means"]));
  fmt::print("95 % interval holds the truth in {:.0f} % of them; true above 1.1 x estimated in {}\n",
             100 * image["interval_covers"].get<double>(), image["true_above_1.1_estimated"].get<size_t>());
  if (const Json& above = image["true_above_1.1_asked"]; !above.is_null())
    fmt::print("true above 1.1 x asked in {}\n", above.get<size_t>());
}

/// Without an error layer it could not be told whose errors are seen.
Reference read_reference_with_error(const std::string& file) {
  Reference reference = read_reference(file);
  if (reference.standard_error.values.empty())
    throw Error(ErrorKind::input, file, {},
                "has no layer 'error'; render the reference with vernier render --adaptive off --aov error");
  return reference;
}

ExitCode run_bench_calibration(const CalibrationFlags& flags, const Program& program) {
  require_scene(flags.render.scene, "bench calibration");
  if (!flags.json.empty()) check_writable(flags.json);
  if (flags.reference.empty() && flags.seeds < fewest_runs_without_reference)
    throw Error(ErrorKind::usage, fmt::format("--seeds: at least {} without --reference, since each run is "
                                              "compared with the mean of the others",
                                              fewest_runs_without_reference));
  std::optional<Reference> given;
  if (!flags.reference.empty()) given = read_reference_with_error(flags.reference);
  auto [read, view, options] = read_bench_scene(flags.render, given ? &given->picture : nullptr);
  const Scene& scene = *read;
  options.limits.spp = flags.spp;
  if (!flags.render.error.empty()) {
    options.limits.spp = 0;
    options.limits.error = parse_fraction(flags.render.error);
  }
  const Camera camera(view, options.width, options.height);
  const auto integrator =
      find_by_name(integrators(), "integrator", "path").make(flags.render.integrator_options);
  std::vector<CalibrationRun> runs;
  for (int seed = 1; seed <= flags.seeds; ++seed) {
    fmt::print(stderr, "seed {} of {}\n", seed, flags.seeds);
    options.seed = uint64_t(seed);
    runs.emplace_back(render(scene, camera, *integrator, options, never_stop));
  }
  Json report = bench_header(program);
  report["scene"] = flags.render.scene;
  report["width"] = options.width;
  report["height"] = options.height;
  report["reference"] = given ? given->json : Json(nullptr);
  report.update(calibrate(runs, given, options.limits.error));
  print_report(report);
  if (!flags.json.empty())
    write_file(flags.json, report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return ExitCode::done;
}

}  // namespace

void register_bench_calibration(CLI::App& bench, Program& program) {
  CLI::App* command =
      bench.add_subcommand("calibration", "Whether reported errors are those that pictures have");
  auto flags = std::make_shared<CalibrationFlags>();
  add_scene_flags(*command, flags->render.scene, flags->render.import);
  command->add_option("--spp", flags->spp, "samples a pixel of each run")
      ->transform(whole_number(2, 1 << 30))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--error", flags->render.error, "instead: stop each run at this estimated error")
      ->check(parsed_by(parse_fraction))
      ->type_name("ERROR");
  command->add_option("--seeds", flags->seeds, "runs")
      ->transform(whole_number(1, 1'000'000))
      ->type_name("K")
      ->capture_default_str();
  command
      ->add_option("--reference", flags->reference,
                   "evenly sampled, with the layer error (the mean of the other seeds)")
      ->type_name("FILE");
  add_measured_picture_flags(*command, flags->render);
  add_adaptive_flag(*command, flags->render);
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_bench_calibration(*flags, program); };
  });
}

}  // namespace vernier::apps
