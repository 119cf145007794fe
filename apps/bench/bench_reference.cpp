// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/bench_reference.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "apps/vernier/choose_camera.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/notice_log.h"
#include "apps/vernier/surroundings.h"
#include "core/base/names.h"
#include "core/image/image_io.h"
#include "scene/camera.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr int longest_side = 256;  // pixels, where no size was asked for

}  // namespace

const std::atomic<bool> never_stop{false};

Reference read_reference(const std::string& file) {
  const LayeredImage layers = read_layers(file);
  if (!layers.linear)
    throw Error(ErrorKind::input, file, {},
                "holds display values; expected a scene-linear reference, as in .exr");
  Reference reference{
      layers.rgb(), 0, layers.layer("error").value_or(Image()), {{"file", file}, {"rel_rmse", nullptr}}};
  const auto error = layers.metadata.find("vernier:relRmse");
  double value = 0;
  if (error != layers.metadata.end()) {
    const std::string& text = error->second;
    if (std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc()) {
      reference.json["rel_rmse"] = value;
      reference.rel_mse = value * value;
    }
  }
  return reference;
}

Reference render_reference(const Scene& scene, const Camera& camera, RenderSettings options, int spp,
                           int max_depth) {
  options.limits.spp = spp;
  options.limits.error = 0;
  options.limits.seconds = std::numeric_limits<double>::infinity();
  IntegratorOptions integrator_options;
  integrator_options.max_depth = max_depth;
  options.seed = reference_seed;
  options.adaptive = false;
  const auto integrator = find_by_name(integrators(), "integrator", "path").make(integrator_options);
  const RenderResult result = render(scene, camera, *integrator, options, never_stop);
  return {result.film.image(),
          square(result.error.rel_rmse),
          error_layers(result.film).standard_error,
          {{"integrator", "path"},
           {"samples_per_pixel", spp},
           {"seconds", result.seconds},
           {"rel_rmse", result.error.rel_rmse}}};
}

float bench_aspect(const RenderFlags& flags, const Image* reference) {
  if (flags.size.empty() && reference) return float(reference->width) / float(reference->height);
  return asked_aspect(flags.size);
}

RenderSettings bench_options(const RenderFlags& flags, const CameraDescription& view,
                             const Image* reference) {
  RenderSettings options;
  options.adaptive = flags.adaptive == "on";
  if (!flags.size.empty()) {
    const PixelSize size = parse_pixel_size(flags.size);
    options.width = size.width;
    options.height = size.height;
  } else if (reference) {
    options.width = reference->width;
    options.height = reference->height;
  } else {
    fill_in_size(options, view);
    const int longer = std::max(options.width, options.height);
    options.width = std::max(1, options.width * longest_side / longer);
    options.height = std::max(1, options.height * longest_side / longer);
  }
  check_picture_size(options, {}, {});
  if (reference && (reference->width != options.width || reference->height != options.height))
    throw Error(ErrorKind::usage,
                fmt::format("the reference has {}x{} pixels and --size asks for {}x{}", reference->width,
                            reference->height, options.width, options.height));
  return options;
}

BenchScene read_bench_scene(const RenderFlags& flags, const Image* reference) {
  NoticeLog log(false);
  SceneDescription description = import_scene(flags.scene, flags.import);
  const auto surroundings = read_surroundings(flags.surroundings);
  replace_surroundings(description, surroundings, log);
  log.add(description.notices);
  const auto chosen = choose_camera(description.cameras, flags.camera, log);
  BenchScene read;
  read.scene = std::make_unique<Scene>(std::move(description), SceneOptions{flags.accelerator});
  read.view = place_camera(chosen, flags.camera, read.scene->geometry(), bench_aspect(flags, reference), log);
  read.options = bench_options(flags, read.view, reference);
  set_environment(*read.scene, surroundings, read.view, read.options, log);
  log.add(read.scene->notices());
  return read;
}

void add_measured_picture_flags(CLI::App& command, RenderFlags& flags) {
  command.add_option("--size", flags.size, "of the picture (the reference's, else 256 pixels long)")
      ->check(parsed_by(parse_pixel_size))
      ->type_name("WxH");
  add_camera_flags(command, flags.camera);
  add_max_depth_flag(command, flags);
  add_surroundings_flags(command, flags.surroundings);
}

}  // namespace vernier::apps
