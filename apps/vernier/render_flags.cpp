// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_flags.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "apps/vernier/denoising.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/fog_flag.h"
#include "apps/vernier/light_flags.h"
#include "core/base/quantities.h"
#include "core/denoise/denoise.h"
#include "integrators/render/layers.h"
#include "integrators/render/pixel_filter.h"
#include "scene/accel/accelerator.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

void add_quality_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Picture and effort");
  command.add_option("--spp", flags.spp, "samples a pixel on average (64 unless --time or --error is given)")
      ->transform(whole_number(1, 1 << 30))
      ->type_name("N");
  command.add_option("--time", flags.time, "stop rendering after this long: 90s, 10m, 1.5h")
      ->check(parsed_by(parse_seconds))
      ->type_name("TIME");
  command
      .add_option("--error", flags.error,
                  "stop when the picture's relative RMSE is at most this, and the end of its interval at "
                  "most a tenth more: 1%, 0.01")
      ->check(parsed_by(parse_fraction))
      ->type_name("ERROR");
  add_adaptive_flag(command, flags);
  command
      .add_option("--size,--resolution", flags.size,
                  "size of the picture (the camera's shape, 1280 pixels long)")
      ->check(parsed_by(parse_pixel_size))
      ->type_name("WxH");
  command.add_option("--crop", flags.crop, "render only this part")
      ->check(parsed_by(parse_pixel_rect))
      ->type_name("WxH+X+Y");
  command
      .add_option("--filter", flags.filter, "what a pixel shows of its surroundings; 'help' lists filters")
      ->type_name("NAME[:WIDTH]")
      ->capture_default_str();
  command
      .add_option("--texture-filter", flags.texture_filter,
                  "colors of textures: none (read at points, unbiased) or mip (averaged over what a sample "
                  "stands for, WIDTH pixels at first: less noise, approximated; docs/textures.md)")
      ->type_name("none|mip[:WIDTH]");
  command.add_option("--seed", flags.seed, "seed of the random numbers")
      ->transform(whole_number(0, std::numeric_limits<uint64_t>::max()))
      ->type_name("N")
      ->capture_default_str();
  add_threads_flag(command, flags.threads);
}

void add_integrator_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Light transport");
  IntegratorOptions& options = flags.integrator_options;
  command.add_option("--integrator", flags.integrator, "how light is computed; 'help' lists them")
      ->type_name("NAME")
      ->capture_default_str();
  command.add_option("--show", flags.show, "raycast: what to show; 'help' lists it")->type_name("NAME");
  add_max_depth_flag(command, flags);
  command
      .add_option("--caustics", flags.caustics,
                  "path, gradient: what lamps cast by mirrors and bending glass, and what mirrors and glass "
                  "show of it: auto (where there is some), on, off (docs/caustics.md)")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->type_name("auto|on|off")
      ->capture_default_str();
  command.add_option("--ambient", options.ambient, "whitted: radiance that reaches everything")
      ->transform(real_number(0, 1e30))
      ->type_name("L")
      ->capture_default_str();
  command.add_option("--cutoff", options.cutoff, "whitted: smallest contribution that is still traced")
      ->transform(real_number(0, 1e30))
      ->type_name("X")
      ->capture_default_str();
  command.add_option("--accelerator", flags.accelerator, "ray query structure; 'help' lists them")
      ->type_name("NAME");
  add_surroundings_flags(command, flags.surroundings);
  add_background_flags(command, flags.background);
  add_fog_flag(command, flags.fog);
}

void add_output_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Output");
  command
      .add_option("--aov,--layers", flags.layers,
                  "layers of the .exr beside its colour: error,albedo,...; 'help' lists them, 'all' is all")
      ->type_name("LIST");
  add_light_groups_flag(command, flags.light_groups);
  add_denoise_flag(command, flags);
  add_preview_flags(command, flags.run);
  add_display_flags(command, flags.display);
  add_exr_flags(command, flags.exr);
  command.add_option("--stats", flags.stats, "write what was measured as JSON (docs/stats.md)")
      ->type_name("FILE");
  command
      .add_option("--report", flags.report, "write a page with the picture, its error and what was measured")
      ->type_name("FILE.html");
  command
      .add_option("--progress", flags.progress, "bar, lines, json or none (bar on a terminal, else lines)")
      ->type_name("KIND")
      ->capture_default_str();
  command.add_flag("-q,--quiet", flags.quiet, "say nothing but errors");
  command.add_flag("-v,--verbose", flags.verbose, "say more");
}

template <typename Table>
void print_table(const Table& table) {
  for (const auto& entry : table) fmt::print("{:<12} {}\n", entry.name, entry.description);
}

void print_accelerators(bool all) {
  std::vector<AcceleratorEntry> shown;
  for (const AcceleratorEntry& entry : accelerators())
    if (all || !entry.for_study) shown.push_back(entry);
  print_table(shown);
  if (!all) fmt::print("'--accelerator help-all' lists more, to compare with and to test\n");
}

/// The table as --aov takes it: name, channels in the file, meaning.
void print_layers() {
  for (const Layer& layer : layers())
    fmt::print("{:<21} {}\n{:21} channels {}\n", layer.name, layer.description, "",
               fmt::join(layer.channels.begin(), layer.channels.begin() + layer.channel_count(), ", "));
  fmt::print("'light' is all the light of one way, 'all' everything else but motion\n");
}

void print_filters() {
  for (const FilterEntry& filter : filters())
    fmt::print("{:<20} {}\n", fmt::format("{}:{}", filter.name, filter.width), filter.description);
  fmt::print("the number is the width in pixels, and may be left out\n");
}

}  // namespace

void add_adaptive_flag(CLI::App& command, RenderFlags& flags) {
  command
      .add_option("--adaptive", flags.adaptive, "spend samples where they lower the picture's error: on, off")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off")
      ->capture_default_str();
}

void add_max_depth_flag(CLI::App& command, RenderFlags& flags) {
  command
      .add_option("--max-depth", flags.integrator_options.max_depth,
                  "path vertices after the camera (whitted: at most 20)")
      ->transform(whole_number(1, 65536))
      ->type_name("N")
      ->capture_default_str();
}

void add_picture_flags(CLI::App& command, RenderFlags& flags) {
  add_quality_flags(command, flags);
  add_camera_flags(command, flags.camera);
  add_integrator_flags(command, flags);
}

void add_denoise_flag(CLI::App& command, RenderFlags& flags) {
  command
      .add_option("--denoise", flags.denoise,
                  "filter the noise out before writing; 'help' lists the filters (docs/denoise.md)")
      ->type_name("FILTER");
}

void add_render_flags(CLI::App& command, RenderFlags& flags) {
  command
      .add_option(
          "-o,--output", flags.outputs,
          "picture: .exr (scene-linear), .png or .jpg (for display), - is standard output; may be given "
          "more than once; {name}, {camera}, {variant}, {frame} and #### stand for what it is of")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("SCENE", flags.run.scenes, "glTF 2.0 scenes (.gltf, .glb); - is standard input")
      ->type_name("");
  add_import_flags(command, flags.import);
  add_run_flags(command, flags.run);
  add_picture_flags(command, flags);
  add_output_flags(command, flags);
}

bool print_requested_list(const RenderFlags& flags) {
  if (flags.integrator == "help") {
    print_table(integrators());
  } else if (flags.accelerator == "help" || flags.accelerator == "help-all") {
    print_accelerators(flags.accelerator == "help-all");
  } else if (flags.show == "help") {
    for (const auto& name : raycast_outputs()) fmt::print("{}\n", name);
  } else if (flags.filter == "help") {
    print_filters();
  } else if (flags.layers == "help") {
    print_layers();
  } else {
    return print_requested_denoisers(flags.denoise) || print_requested_views(flags.display);
  }
  return true;
}

}  // namespace vernier::apps
