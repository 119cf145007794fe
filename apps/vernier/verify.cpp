// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "apps/validation/cross_check.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/run_plan.h"
#include "apps/vernier/surroundings.h"
#include "core/base/names.h"
#include "core/base/one_line.h"
#include "core/base/parallel.h"
#include "core/base/quantities.h"
#include "integrators/render/camera_sample.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

struct VerifyFlags {
  std::string scene;
  ImportOptions import;
  ShutterFlags shutter;
  CameraFlags camera;
  uint64_t rays = 1'000'000;
  std::string accelerators = "embree,bvh";
  uint64_t seed = 0;
  unsigned threads = 0;
};

using Pair = std::array<const AcceleratorEntry*, 2>;

Pair parse_pair(const std::string& list) {
  const size_t comma = list.find(',');
  if (comma == std::string::npos || list.find(',', comma + 1) != std::string::npos)
    throw Error(ErrorKind::usage, {}, "--accelerators",
                fmt::format("'{}' are not two names; expected two to compare: embree,bvh", list));
  const auto entry = [&](const std::string& name) {
    return &find_by_name(accelerators(), "accelerator", name);
  };
  return {entry(list.substr(0, comma)), entry(list.substr(comma + 1))};
}

/// Casts the rays of paths through a picture until there are as many as wanted; returns how many paths.
uint64_t trace_paths(const Scene& scene, const validation::CrossCheck& check, const RenderSettings& settings,
                     uint64_t rays) {
  const auto integrator = make_integrator(settings.integrator, settings.integrator_options);
  const Camera camera(settings.camera, settings.width, settings.height);
  const CameraSamples camera_samples(camera, scene, settings);
  uint64_t paths = 0;
  for (uint32_t index = 0; check.rays() < rays; ++index) {
    parallel_for(size_t(settings.height), [&](size_t y) {
      for (int x = 0; x < settings.width && check.rays() < rays; ++x) {
        CameraSample sample = camera_samples.get({x, int(y), 0, index});
        integrator->estimate(scene, sample.ray, sample.sampler, {});
      }
    });
    paths += uint64_t(settings.width) * uint64_t(settings.height);
    if (check.rays() == 0) break;
  }
  return paths;
}

std::string text(const std::optional<RawHit>& hit) {
  return hit ? fmt::format("triangle {} of instance {} at {:.9g}", hit->primitive, hit->instance, hit->t)
             : "nothing";
}

void print(const validation::CrossCheckResult& result, const Pair& pair, const std::string& scene) {
  const uint64_t within_rounding = result.at_boundary + result.at_end + result.tied;
  fmt::print("{}\n", one_line(fmt::format(
                         "{}: {} against {}, {} rays of paths: {} differ by more than rounding, {} by "
                         "rounding",
                         scene, pair[0]->name, pair[1]->name, format_count(double(result.rays)), result.real,
                         within_rounding)));
  fmt::print("  at the edge of a triangle  {} ({} of them met nothing beyond)\n", result.at_boundary,
             result.leaks);
  fmt::print("  two surfaces at one place  {}\n", result.tied);
  fmt::print("  at an end of the ray       {}\n", result.at_end);
  for (const validation::Difference& d : result.examples) {
    const Ray& r = d.ray;
    fmt::print(
        "difference: {}ray from {:.9g} {:.9g} {:.9g} along {:.9g} {:.9g} {:.9g}, t {:.9g} to {:.9g}: {} "
        "meets {}, {} meets {}\n",
        d.is_occlusion ? "shadow " : "", r.origin.x, r.origin.y, r.origin.z, r.direction.x, r.direction.y,
        r.direction.z, r.t_min, r.t_max, pair[0]->name, text(d.mine), pair[1]->name, text(d.other));
  }
}

ExitCode run_verify(const VerifyFlags& flags) {
  require_scene(flags.scene, "verify");
  const Pair pair = parse_pair(flags.accelerators);
  const ThreadLimit threads(flags.threads);
  NoticeLog log(true);
  if (!flags.shutter.shutter.empty() && !flags.import.time)
    throw Error(ErrorKind::usage, "--shutter needs --at, for without a time everything is at rest");
  ImportOptions import = flags.import;
  import.shutter = shutter_of(flags.shutter, frame_seconds(RunFlags{}));
  SceneDescription description = import_scene(flags.scene, import);
  const auto chosen = choose_camera(description.cameras, flags.camera, log);
  check_scene_size(description, import.memory);
  Scene scene(std::move(description), {std::string(pair[0]->name)});
  RenderSettings settings;
  settings.seed = flags.seed;
  settings.camera = place_camera(chosen, flags.camera, scene.geometry(), 0, log);
  fill_in_size(settings, settings.camera);
  fit_lens(settings, flags.camera.lens, scene, log);
  set_environment(scene, std::nullopt, settings.camera, settings, log);

  Geometry unfiltered = scene.accelerated_geometry();
  for (GeometryInstance& instance : unfiltered.instances) instance.filtered = instance.clear = false;
  unfiltered.filter = nullptr;
  auto checking =
      std::make_unique<validation::CrossCheck>(scene.geometry(), pair[0]->build(scene.accelerated_geometry()),
                                               pair[0]->build(unfiltered), pair[1]->build(unfiltered));
  const validation::CrossCheck& check = *checking;
  scene.replace_accelerator(std::move(checking));
  trace_paths(scene, check, settings, flags.rays);
  const validation::CrossCheckResult result = check.result();
  print(result, pair, flags.scene);
  return result.real > 0 ? ExitCode::comparison_failed : ExitCode::done;
}

}  // namespace

void register_verify(Program& program) {
  CLI::App* command = program.app.add_subcommand(
      "verify", "Trace the rays of a scene's paths with two accelerators and tell where they differ");
  auto flags = std::make_shared<VerifyFlags>();
  add_scene_flags(*command, flags->scene, flags->import);
  add_shutter_flag(*command, flags->shutter);
  add_camera_flags(*command, flags->camera);
  command->option_defaults()->group("Check");
  command->add_option("--rays", flags->rays, "how many at least")
      ->transform(whole_number(1, 1'000'000'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--accelerators", flags->accelerators,
                   "the two to compare; the first one's paths are taken")
      ->type_name("A,B")
      ->capture_default_str();
  command->add_option("--seed", flags->seed, "seed of the paths")->type_name("N")->capture_default_str();
  command->add_option("-t,--threads", flags->threads, "0: all")->type_name("N")->capture_default_str();
  command->footer("Example: vernier verify scene.glb --rays 100000000\nExit code 1: one of them is wrong.");
  command->callback([&program, flags] { program.run = [flags] { return run_verify(*flags); }; });
}

}  // namespace vernier::apps
