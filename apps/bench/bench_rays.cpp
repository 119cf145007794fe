// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/ray_timing.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/scene_summary.h"
#include "apps/vernier/surroundings.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "core/base/quantities.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// What the others are measured against.
constexpr std::string_view yardstick = "embree";

struct BenchRaysFlags {
  std::string scene;
  ImportOptions import;
  std::vector<std::string> accelerators{"all"};
  int paths = 200'000;
  int repetitions = 5;
  CameraFlags camera;
  std::string json;
};

/// Median over the repetitions of how many times as fast as the yardstick, taken within each.
double ratio(const std::vector<double>& yardstick_seconds, const std::vector<double>& seconds) {
  std::vector<double> ratios;
  for (size_t i = 0; i < seconds.size(); ++i) ratios.push_back(yardstick_seconds[i] / seconds[i]);
  return median(ratios);
}

struct Rate {
  std::string_view kind;
  double rays_per_second, to_yardstick;
};

/// Of each kind that there are rays of, and of all together.
std::vector<Rate> rates(const TimedAccelerator& candidate, const TimedAccelerator& embree, size_t threads,
                        const PathRays& rays) {
  std::vector<Rate> result;
  size_t all = 0;
  for (size_t k = 0; k < ray_kinds.size(); ++k) {
    const size_t count = (rays.*ray_kinds[k].rays).size();
    all += count;
    if (count == 0) continue;
    const auto& seconds = candidate.seconds[threads][k];
    result.push_back(
        {ray_kinds[k].name, double(count) / median(seconds), ratio(embree.seconds[threads][k], seconds)});
  }
  const auto mixed = candidate.mixed_seconds(threads);
  result.push_back({"mixed", double(all) / median(mixed), ratio(embree.mixed_seconds(threads), mixed)});
  return result;
}

Json candidate_json(const TimedAccelerator& candidate, const TimedAccelerator& embree, const PathRays& rays,
                    double triangles) {
  const AcceleratorStats stats = candidate.accelerator->stats();
  Json json = {{"name", candidate.entry->name},
               {"build_seconds", median(candidate.build_seconds)},
               {"bytes", stats.bytes},
               {"bytes_per_triangle", double(stats.bytes) / triangles},
               {"every_nth_ray", candidate.stride}};
  for (size_t k = 0; k < ray_kinds.size(); ++k)
    if (const auto& cost = candidate.cost[k])
      json["per_ray"][std::string(ray_kinds[k].name)] = {{"nodes", cost->nodes},
                                                         {"blocks_of_four_triangles", cost->blocks}};
  for (const RayKind& kind : ray_kinds)
    json["differing_per_million"][std::string(kind.name)] =
        differing_per_million(candidate, embree, kind, rays.*kind.rays);
  for (const size_t threads : {0, 1})
    for (const Rate& rate : rates(candidate, embree, threads, rays))
      json["rays_per_second"][threads == 0 ? "one_thread" : "all_threads"][std::string(rate.kind)] = {
          {"median", rate.rays_per_second}, {"ratio_to_embree", rate.to_yardstick}};
  return json;
}

std::string rate_table(const std::vector<TimedAccelerator>& candidates, const TimedAccelerator& embree,
                       const PathRays& rays, size_t threads) {
  std::vector<std::vector<std::string>> rows{{"Mrays/s (x embree)"}};
  for (const Rate& rate : rates(embree, embree, threads, rays)) rows[0].emplace_back(rate.kind);
  for (const TimedAccelerator& candidate : candidates) {
    rows.push_back({std::string(candidate.entry->name)});
    for (const Rate& rate : rates(candidate, embree, threads, rays))
      rows.back().push_back(fmt::format("{:.3g} ({:.2f})", rate.rays_per_second / 1e6, rate.to_yardstick));
  }
  return text_table(rows);
}

std::string structure_table(const std::vector<TimedAccelerator>& candidates, const TimedAccelerator& embree,
                            double triangles) {
  std::vector<std::vector<std::string>> rows{
      {"structure", "build", "(x embree)", "bytes/triangle", "nodes/bounce ray", "blocks/bounce ray"}};
  for (const TimedAccelerator& candidate : candidates) {
    const auto& cost = candidate.cost[1];
    rows.push_back({std::string(candidate.entry->name), format_seconds(median(candidate.build_seconds)),
                    fmt::format("{:.2f}", median(candidate.build_seconds) / median(embree.build_seconds)),
                    fmt::format("{:.1f}", double(candidate.accelerator->stats().bytes) / triangles),
                    cost ? fmt::format("{:.1f}", cost->nodes) : "-",
                    cost ? fmt::format("{:.1f}", cost->blocks) : "-"});
  }
  return text_table(rows);
}

std::string difference_table(const std::vector<TimedAccelerator>& candidates, const TimedAccelerator& embree,
                             const PathRays& rays) {
  std::vector<std::vector<std::string>> rows{{"answers unlike embree's"}};
  for (const RayKind& kind : ray_kinds) rows[0].emplace_back(kind.name);
  for (const TimedAccelerator& candidate : candidates) {
    rows.push_back({std::string(candidate.entry->name)});
    for (const RayKind& kind : ray_kinds)
      rows.back().push_back(
          fmt::format("{:.3g}", differing_per_million(candidate, embree, kind, rays.*kind.rays)));
  }
  return text_table(rows);
}

ExitCode run_bench_rays(const BenchRaysFlags& flags, const Program& program) {
  require_scene(flags.scene, "bench rays");
  if (!flags.json.empty()) check_writable(flags.json);
  std::vector<TimedAccelerator> candidates;
  std::vector<std::string> names = flags.accelerators;
  names.emplace_back(yardstick);
  for (const AcceleratorEntry* entry : accelerators_named(names)) candidates.emplace_back(*entry);
  const TimedAccelerator& embree = *std::find_if(candidates.begin(), candidates.end(),
                                                 [](const auto& c) { return c.entry->name == yardstick; });

  NoticeLog log(false);
  const auto start = Clock::now();
  SceneDescription description = import_scene(flags.scene, flags.import);
  const double load_seconds = std::chrono::duration<double>(Clock::now() - start).count();
  const SceneCounts counts = count(description);
  if (counts.triangles == 0)
    throw Error(ErrorKind::input, flags.scene, {}, "has no triangles to cast rays at");
  const auto chosen = choose_camera(description.cameras, flags.camera, log);
  Scene scene(std::move(description), {std::string(yardstick)});
  const CameraDescription view = place_camera(chosen, flags.camera, scene.geometry(), 0, log);
  RenderSettings shape;
  fill_in_size(shape, view);
  set_environment(scene, std::nullopt, view, shape, log);

  constexpr int max_bounces = 4;
  const PathRays rays = record_path_rays(scene, view, static_cast<size_t>(flags.paths), max_bounces);
  time_accelerators(candidates, scene.accelerated_geometry(), rays, flags.repetitions);

  const auto triangles = double(counts.triangles);
  fmt::print("{}: {} triangles in {} instances, loaded in {}\n", flags.scene, counts.triangles,
             counts.instances, format_seconds(load_seconds));
  fmt::print(
      "{} primary, {} bounce and {} shadow rays of {} paths; medians of {} interleaved repetitions\n\n",
      rays.primary.size(), rays.bounce.size(), rays.shadow.size(), rays.primary.size(), flags.repetitions);
  fmt::print("{}\n", structure_table(candidates, embree, triangles));
  fmt::print("one thread\n{}\n", rate_table(candidates, embree, rays, 0));
  fmt::print("{} threads\n{}\n", thread_count(), rate_table(candidates, embree, rays, 1));
  fmt::print("per 10^6 rays\n{}", difference_table(candidates, embree, rays));
  if (flags.json.empty()) return ExitCode::done;

  Json json = bench_header(program);
  json["scene"] = {{"file", flags.scene}, {"load_seconds", load_seconds}, {"counts", to_json(counts)}};
  json["camera"] = view.name;
  json["repetitions"] = flags.repetitions;
  for (const RayKind& kind : ray_kinds) json["rays"][std::string(kind.name)] = (rays.*kind.rays).size();
  for (const TimedAccelerator& candidate : candidates)
    json["accelerators"].push_back(candidate_json(candidate, embree, rays, triangles));
  write_file(flags.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return ExitCode::done;
}

}  // namespace

void register_bench_rays(CLI::App& bench, Program& program) {
  CLI::App* command =
      bench.add_subcommand("rays", "How fast each accelerator builds and answers rays, beside Embree");
  auto flags = std::make_shared<BenchRaysFlags>();
  add_scene_flags(*command, flags->scene, flags->import);
  command
      ->add_option("--accelerator", flags->accelerators,
                   "which to measure, separated by commas, or all; Embree always is")
      ->delimiter(',')
      ->type_name("NAMES")
      ->capture_default_str();
  command->add_option("--paths", flags->paths, "recorded, whose rays are then timed")
      ->transform(whole_number(1, 1 << 24))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--repetitions", flags->repetitions, "of every measurement")
      ->transform(whole_number(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  add_camera_flags(*command, flags->camera);
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->callback(
      [&program, flags] { program.run = [&program, flags] { return run_bench_rays(*flags, program); }; });
}

}  // namespace vernier::apps
