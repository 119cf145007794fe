// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/scale_scenes.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/machine.h"
#include "apps/vernier/stopwatch.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"
#include "core/base/parallel.h"
#include "core/base/resident_memory.h"
#include "integrators/render/render.h"
#include "scene/accel/accelerator.h"
#include "scene/scene.h"
#include "vernier/session.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct ScaleFlags {
  std::vector<std::string> axes{"all"};
  double largest = 1e6;
  std::string json;
};

/// What a phase took.
struct Cost {
  double seconds = 0;    ///< by the clock on the wall
  double processor = 0;  ///< of all threads
  /// Of it, what the calling thread did while the others had nothing to do: its own time less the mean of
  /// theirs, since work for all is shared evenly. NaN with one thread. Other programs disturb it less than
  /// they do the clock on the wall.
  double serial = 0;
};

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Adds what a call takes to `cost`.
template <typename Call>
auto measured(Cost& cost, const Call& call) {
  Stopwatch watch;
  const double own_before = thread_seconds(), all_before = cpu_seconds();
  auto result = call();
  const double own = thread_seconds() - own_before, all = cpu_seconds() - all_before;
  cost.seconds += watch.lap();
  cost.processor += all;
  const unsigned others = thread_count() - 1;
  cost.serial += others > 0 ? std::max(0.0, own - (all - own) / others) : std::nan("");
  return result;
}

struct Picture {
  int width = 256, height = 144;
  int spp = 16, depth = 16;
};

/// One size along one axis.
struct Point {
  double size = 0;
  Cost build, render;
  size_t scene_bytes = 0;  ///< that the scene keeps once it is built
  uint64_t samples = 0;
};

RenderSettings settings_of(const Picture& picture, const Scene& scene) {
  RenderSettings settings;
  settings.width = picture.width;
  settings.height = picture.height;
  settings.limits.spp = picture.spp;
  settings.integrator_options.max_depth = picture.depth;
  settings.camera = fitted_camera(scene, float(picture.width) / float(picture.height));
  return settings;
}

Point measure(double size, const std::function<SceneDescription()>& describe, const Picture& picture) {
  Point point;
  point.size = size;
  const size_t before = resident_bytes();
  SceneDescription description = describe();
  if (description.materials.size() == 1) description.environment = built_in_environment("sky");
  const auto settings_and_scene = measured(point.build, [&] {
    auto scene = build_scene(std::move(description), {});
    return std::pair(settings_of(picture, *scene), scene);
  });
  const auto& [settings, scene] = settings_and_scene;
  const size_t after = resident_bytes();
  point.scene_bytes = after > before ? after - before : 0;
  point.samples = measured(point.render, [&, s = settings, shown = scene] {
    RenderSession session(shown, s);
    session.run();
    (void)session.picture();
    return session.result().samples;
  });
  return point;
}

/// What is scaled, and the sizes that there are of it.
struct Axis {
  const char* name;
  std::vector<double> sizes;
  Point (*measure)(double size);
};

constexpr size_t some_triangles = 100'000;
/// Of these the last few are planned.
constexpr int spp_with_a_plan = 20;

std::vector<Axis> axes() {
  std::vector<double> threads;
  for (unsigned count = 1; count < thread_count(); count *= 2) threads.push_back(count);
  threads.push_back(thread_count());
  return {
      {"triangles",
       {1e4, 1e5, 1e6, 1e7, 1e8},
       [](double n) { return measure(n, [n] { return scene_of_triangles(size_t(n)); }, {}); }},
      {"instances",
       {1, 1e2, 1e4, 1e5, 1e6},
       [](double n) { return measure(n, [n] { return scene_of_instances(size_t(n)); }, {}); }},
      {"lights",
       {1, 1e2, 1e4, 1e5, 1e6, 1e7},
       [](double n) { return measure(n, [n] { return scene_of_lights(size_t(n)); }, {}); }},
      {"pixels",
       {256 * 144, 1024 * 576, 1920 * 1080, 3840 * 2160, 7680 * 4320},
       [](double n) {
         const int height = int(std::lround(std::sqrt(n * 9 / 16)));
         return measure(n, [] { return scene_of_triangles(some_triangles); },
                        {int(std::lround(n / height)), height, spp_with_a_plan});
       }},
      {"depth",
       {1, 2, 4, 8, 16, 64},
       [](double n) {
         return measure(n, [] { return scene_of_lights(100); }, {256, 144, 64, int(n)});
       }},
      {"threads", threads,
       [](double n) {
         const ThreadLimit limit{unsigned(n)};
         return measure(n, [] { return scene_of_triangles(10 * some_triangles); }, {512, 288, 64});
       }},
  };
}

Json cost_json(const Cost& cost) {
  return {{"seconds", cost.seconds},
          {"processor_seconds", cost.processor},
          {"serial_share",
           std::isfinite(cost.serial) ? Json(std::min(1.0, cost.serial / cost.processor)) : Json(nullptr)}};
}

Json point_json(const Point& point) {
  return {{"size", point.size},
          {"build", cost_json(point.build)},
          {"scene_bytes", point.scene_bytes},
          {"render", cost_json(point.render)},
          {"samples", point.samples},
          {"nanoseconds_per_sample", 1e9 * point.render.processor / double(point.samples)}};
}

std::string percent(const Json& share) {
  return share.is_null() ? "-" : fmt::format("{:.1f} %", 100 * share.get<double>());
}

void print_axis(const Json& axis) {
  std::vector<std::vector<std::string>> rows{{axis["name"].get<std::string>(), "build, s",
                                              "on all threads, s", "serial", "scene, MB", "render, s",
                                              "serial", "ns a sample"}};
  for (const Json& point : axis["points"])
    rows.push_back({fmt::format("{:.6g}", point["size"].get<double>()),
                    fmt::format("{:.3f}", point["build"]["seconds"].get<double>()),
                    fmt::format("{:.3f}", point["build"]["processor_seconds"].get<double>()),
                    percent(point["build"]["serial_share"]),
                    fmt::format("{:.1f}", 1e-6 * point["scene_bytes"].get<double>()),
                    fmt::format("{:.3f}", point["render"]["seconds"].get<double>()),
                    percent(point["render"]["serial_share"]),
                    fmt::format("{:.0f}", point["nanoseconds_per_sample"].get<double>())});
  fmt::print("{}\n", text_table(rows));
  std::fflush(stdout);
}

ExitCode run_bench_scale(const ScaleFlags& flags, const Program& program) {
  if (!flags.json.empty()) check_writable(flags.json);
  const std::vector<Axis> all = axes();
  const bool every = flags.axes == std::vector<std::string>{"all"};
  for (const auto& name : flags.axes)
    if (!every) find_by_name(all, "axis", name);
  Json report = bench_header(program);
  report["axes"] = Json::array();
  for (const Axis& axis : all) {
    if (!every && std::find(flags.axes.begin(), flags.axes.end(), axis.name) == flags.axes.end()) continue;
    Json measured = {{"name", axis.name}, {"points", Json::array()}};
    for (const double size : axis.sizes)
      if (size <= flags.largest) measured["points"].push_back(point_json(axis.measure(size)));
    print_axis(measured);
    report["axes"].push_back(std::move(measured));
  }
  if (!flags.json.empty())
    write_file(flags.json, report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return ExitCode::done;
}

}  // namespace

void register_bench_scale(CLI::App& bench, Program& program) {
  CLI::App* command =
      bench.add_subcommand("scale", "What building and rendering cost as scenes, pictures and machines grow");
  auto flags = std::make_shared<ScaleFlags>();
  command->add_option("--axis", flags->axes, "triangles, instances, lights, pixels, depth, threads, or all")
      ->delimiter(',')
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--largest", flags->largest,
                   "leave out sizes beyond this, of triangles, instances, lights or pixels")
      ->check(real_number(1, 1e9))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->callback(
      [&program, flags] { program.run = [&program, flags] { return run_bench_scale(*flags, program); }; });
}

}  // namespace vernier::apps
