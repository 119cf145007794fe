// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/bench_reference.h"
#include "apps/bench/convergence.h"
#include "apps/report/convergence_page.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/outputs.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Flags {
  ConvergencePlan plan;
  std::vector<std::string> times{"1", "2", "4", "8"};
  std::string out;
};

/// The plan with everything checked that can be checked without importing a scene.
ConvergencePlan checked_plan(const Flags& flags) {
  ConvergencePlan plan = flags.plan;
  if (plan.scenes.empty())
    throw Error(ErrorKind::usage, "missing SCENES (.gltf, .glb); see vernier bench convergence --help");
  if (flags.out.empty())
    throw Error(ErrorKind::usage, "missing --out DIR; see vernier bench convergence --help");
  if (!plan.references.empty() && plan.references.size() != plan.scenes.size())
    throw Error(ErrorKind::usage,
                fmt::format("{} scenes and {} references; give --reference once a scene, in order",
                            plan.scenes.size(), plan.references.size()));
  for (const auto& name : plan.integrators) find_by_name(integrators(), "integrator", name);
  std::vector<std::string> accelerator_names;
  for (const AcceleratorEntry* entry : accelerators_named(plan.accelerators))
    accelerator_names.emplace_back(entry->name);
  // Else the one that a render of each scene would take.
  if (accelerator_names.empty()) accelerator_names.emplace_back();
  plan.accelerators = accelerator_names;
  for (const auto& time : flags.times) plan.times.push_back(parse_seconds(time));
  std::sort(plan.times.begin(), plan.times.end());
  plan.times.erase(std::unique(plan.times.begin(), plan.times.end()), plan.times.end());
  // What is wrong with the last one should not be found out when all others have been measured.
  for (const auto& scene : plan.scenes) require_readable(scene);
  for (const auto& reference : plan.references) read_reference(reference);
  return plan;
}

std::string csv(const std::vector<SceneConvergence>& scenes) {
  std::string text =
      "scene,integrator,accelerator,load_seconds,build_seconds,asked_seconds,seed,seconds,samples_per_pixel,"
      "rays,rel_rmse,estimated_rel_rmse,estimated_low,estimated_high,unreliable\n";
  const auto quoted = [](const Json& value) {
    std::string field = "\"";
    for (const char c : value.get<std::string>()) field += c == '"' ? std::string("\"\"") : std::string(1, c);
    return field + "\"";
  };
  const auto number = [](const Json& value) { return value.is_null() ? "" : value.dump(); };
  for (const SceneConvergence& scene : scenes)
    for (const Json& candidate : scene.json["candidates"])
      for (const Json& point : candidate["points"])
        for (const Json& run : point["runs"]) {
          const Json& estimate = run["estimated"];
          text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", quoted(scene.json["file"]),
                              quoted(candidate["integrator"]), quoted(candidate["accelerator"]),
                              number(scene.json["load_seconds"]), number(candidate["build_seconds"]),
                              number(point["asked_seconds"]), number(run["seed"]), number(run["seconds"]),
                              number(run["samples_per_pixel"]), number(run["rays"]), number(run["rel_rmse"]),
                              number(estimate["rel_rmse"]), number(estimate["low"]), number(estimate["high"]),
                              number(estimate["unreliable"]));
        }
  return text;
}

void print_summary(const std::vector<SceneConvergence>& scenes) {
  std::vector<std::vector<std::string>> rows{
      {"scene", "integrator", "accelerator", "seconds", "spp", "error", "slope", "efficiency"}};
  for (const SceneConvergence& scene : scenes)
    for (const Json& candidate : scene.json["candidates"]) {
      const Json& last = candidate["points"].back();
      const Json& fit = candidate["fit"];
      rows.push_back(
          {fs::path(scene.json["file"].get<std::string>()).filename().string(), candidate["integrator"],
           candidate["accelerator"], fmt::format("{:.2f}", last["seconds"].get<double>()),
           fmt::format("{:.4g}", last["samples_per_pixel"].get<double>()),
           fmt::format("{:.3g} %", 100 * last["rel_rmse"]["median"].get<double>()),
           fit.is_null() ? "-" : fmt::format("{:.2f}", fit["slope"].get<double>()),
           last["efficiency"].is_null() ? "-" : fmt::format("{:.4g}", last["efficiency"].get<double>())});
    }
  fmt::print("{}", text_table(rows));
}

/// "scenes 2, candidates of each 4, seeds 5: 10 m 00 s of rendering"
std::string announcement(const ConvergencePlan& plan) {
  double seconds = 0;
  for (const double time : plan.times) seconds += time;
  const size_t candidates = plan.integrators.size() * plan.accelerators.size();
  seconds *= double(plan.scenes.size() * candidates) * plan.seeds;
  return fmt::format("scenes {}, candidates of each {}, seeds {}: {} of rendering{}", plan.scenes.size(),
                     candidates, plan.seeds, format_seconds(seconds),
                     plan.references.empty() ? ", and the references" : "");
}

ExitCode run_bench_convergence(const Flags& flags, const Program& program) {
  const ConvergencePlan plan = checked_plan(flags);
  const fs::path folder(flags.out);
  std::error_code failed;
  fs::create_directories(folder, failed);  // a failure shows at the first file
  const auto file = [&](const char* name) { return (folder / name).string(); };
  for (const char* name : {"convergence.csv", "convergence.json", "convergence.html"})
    check_writable(file(name));

  NoticeLog log(false);
  Outputs outputs;
  std::vector<SceneConvergence> scenes;
  Json report = bench_header(program);
  report["times"] = plan.times;
  report["seeds"] = plan.seeds;
  fmt::print(stderr, "{}\n", announcement(plan));
  for (size_t i = 0; i < plan.scenes.size(); ++i) {
    scenes.push_back(measure_convergence(plan, i, log));
    report["scenes"].push_back(scenes.back().json);
    // After each scene: who stops a long bench keeps what has been measured.
    const std::string json = report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    outputs.attempt([&] { write_file(file("convergence.csv"), csv(scenes)); });
    outputs.attempt([&] { write_file(file("convergence.json"), json); });
    outputs.attempt([&] { write_file(file("convergence.html"), convergence_page(report, scenes)); });
  }
  print_summary(scenes);
  return outputs.have_failed() ? ExitCode::input : ExitCode::done;
}

void add_plan_flags(CLI::App& command, Flags& flags) {
  ConvergencePlan& plan = flags.plan;
  command.add_option("SCENES", plan.scenes, "glTF 2.0 scenes")->type_name("");
  const auto names = [&](const char* flag, std::vector<std::string>& target, const char* description) {
    return command.add_option(flag, target, description)->delimiter(',')->type_name("NAMES");
  };
  plan.integrators = {"path"};
  names("--integrator", plan.integrators, "which to measure, separated by commas")->capture_default_str();
  names("--accelerator", plan.accelerators,
        "which to measure, separated by commas, or all (as render takes)");
  command.add_option("--reference", plan.references, "picture to measure against, once a scene, in order")
      ->type_name("FILE")
      ->allow_extra_args(false);
  plan.reference_spp = 2048;
  command.add_option("--reference-spp", plan.reference_spp, "else: path traced, this many samples a pixel")
      ->transform(whole_number(2, 1 << 30))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--times", flags.times, "of rendering, separated by commas")
      ->delimiter(',')
      ->check(parsed_by(parse_seconds))
      ->type_name("TIMES")
      ->capture_default_str();
  plan.seeds = 5;
  command.add_option("--seeds", plan.seeds, "runs of each time")
      ->transform(whole_number(1, 10000))
      ->type_name("K")
      ->capture_default_str();
}

}  // namespace

void register_bench_convergence(CLI::App& bench, Program& program) {
  CLI::App* command = bench.add_subcommand("convergence", "Error against a reference over time and samples");
  auto flags = std::make_shared<Flags>();
  RenderFlags& render = flags->plan.render;
  add_plan_flags(*command, *flags);
  command->add_option("--out", flags->out, "folder for convergence.csv, .json and .html")->type_name("DIR");
  add_measured_picture_flags(*command, render);
  add_adaptive_flag(*command, render);
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_bench_convergence(*flags, program); };
  });
}

}  // namespace vernier::apps
