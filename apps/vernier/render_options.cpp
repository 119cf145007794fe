// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "apps/vernier/denoising.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/fog_flag.h"
#include "apps/vernier/light_flags.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/picture_output.h"
#include "apps/vernier/stopwatch.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"
#include "core/image/image_io.h"
#include "integrators/render/pixel_filter.h"
#include "integrators/render/settings_identity.h"
#include "integrators/render/texture_filter.h"
#include "scene/accel/accelerator.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

/// Only OpenEXR holds more than a picture's colour. Denoising brings the layers that it uses.
std::string choose_layers(const RenderFlags& flags) {
  const auto is_display = [&](const auto& output) { return is_display_output(output, flags.run.format); };
  const bool has_layers = !flags.layers.empty() || !flags.light_groups.empty();
  if (has_layers && std::all_of(flags.outputs.begin(), flags.outputs.end(), is_display))
    throw Error(ErrorKind::usage, {}, flags.layers.empty() ? "--light-groups" : "--aov",
                "only an .exr can hold layers; add -o FILE.exr, which may be given beside other outputs");
  std::string list = flags.layers;
  const auto add = [&](std::string_view more) { list += (list.empty() ? "" : ",") + std::string(more); };
  if (!flags.light_groups.empty()) add("light_groups");
  if (!flags.denoise.empty()) add(layers_for_denoising);
  return list;
}

ProgressMode parse_progress(const RenderFlags& flags) {
  struct Entry {
    std::string_view name;
    ProgressMode mode;
  };
  constexpr Entry table[] = {{"auto", ProgressMode::automatic},
                             {"bar", ProgressMode::bar},
                             {"lines", ProgressMode::lines},
                             {"json", ProgressMode::json},
                             {"none", ProgressMode::none}};
  const ProgressMode mode = find_by_name(table, "--progress", flags.progress).mode;
  return flags.quiet && mode == ProgressMode::automatic ? ProgressMode::none : mode;
}

RenderSettings make_settings(const RenderFlags& flags) {
  RenderSettings options;
  options.integrator = flags.integrator;
  options.integrator_options = flags.integrator_options;
  if (!flags.show.empty()) {
    if (flags.integrator != "raycast") throw Error(ErrorKind::usage, "--show needs --integrator raycast");
    options.integrator_options.show = flags.show;
  }
  options.integrator_options.caustics = parse_caustics(flags.caustics);
  make_integrator(options.integrator, options.integrator_options);  // or it throws
  options.filter = parse_filter(flags.filter);
  if (!flags.texture_filter.empty()) options.texture_filter = parse_texture_filter(flags.texture_filter);
  check_texture_filter(options);
  options.row_exposure = row_exposure_of(flags.run.shutter);
  options.seed = flags.seed;
  if (!flags.time.empty()) options.limits.seconds = parse_seconds(flags.time);
  if (!flags.error.empty()) options.limits.error = parse_fraction(flags.error);
  options.adaptive = flags.adaptive == "on";
  options.limits.spp = flags.spp.value_or(flags.time.empty() && flags.error.empty() ? 64 : 0);
  if (!flags.size.empty()) {
    const PixelSize size = parse_pixel_size(flags.size);
    options.width = size.width;
    options.height = size.height;
  }
  if (!flags.crop.empty()) {
    const PixelRect rect = parse_pixel_rect(flags.crop);
    options.crop = {rect.x, rect.y, rect.width, rect.height};
  }
  return options;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The view is the one asked for, else the config's default, but for raycast's pictures: they are data and go
/// to the display unchanged where the config has a raw view.
DisplayOptions choose_display(const RenderFlags& flags) {
  DisplayOptions display = flags.display;
  const bool needed = !display.view.empty() || !display.config.empty() || !flags.report.empty();
  if (!needed && !has_display_output(flags)) return display;
  if (display.view.empty() && flags.integrator == "raycast")
    for (const auto& view : display_views(display))
      if (equal_ignoring_case(view, "raw")) display.view = view;
  return with_chosen_view(display);
}

/// Throws Error(usage) where what is asked for to the letter is to be approximated.
void check_strict(const RenderFlags& flags, const RenderSettings& settings) {
  if (flags.import.strict && settings.texture_filter.is_on())
    throw Error(ErrorKind::usage, {}, "--texture-filter",
                fmt::format("{} approximates the colors of textures, and --strict asks for a scene that is "
                            "honoured exactly; leave one of both out",
                            texture_filter_text(settings.texture_filter)));
}

/// What --draft asks for where nothing else does. Noise is all that a draft filters, and raycast has none.
/// What textures lose is less than what a filter of noise takes of them: of a far chequered floor a draft is
/// half as wrong (docs/textures.md).
RenderFlags with_draft(RenderFlags flags) {
  constexpr int spp = 8;
  if (!flags.run.draft) return flags;
  if (!flags.spp && flags.time.empty() && flags.error.empty()) flags.spp = spp;
  if (flags.denoise.empty() && flags.integrator != "raycast") flags.denoise = "nlm";
  const bool reads_areas = flags.integrator == "path" || flags.integrator == "whitted";
  if (flags.texture_filter.empty() && reads_areas && !flags.import.strict) flags.texture_filter = "mip";
  return flags;
}

void check_standard_output(const RenderFlags& flags) {
  const auto count = std::count_if(flags.outputs.begin(), flags.outputs.end(), is_standard_stream);
  if (count > 1) throw Error(ErrorKind::usage, "-o - is given twice and standard output takes one picture");
  if (count == 0 && !flags.run.format.empty())
    throw Error(ErrorKind::usage, "--format needs -o -; the names of files tell their format");
}

/// A render that is to be gone on with or merged needs no picture.
void check_outputs(const RenderFlags& flags) {
  const auto refuse = [](const char* problem) { throw Error(ErrorKind::usage, problem); };
  if (flags.outputs.empty() && flags.checkpoint.empty())
    refuse("missing -o FILE (.exr, .png, .jpg) or --checkpoint FILE; see vernier render --help");
  if (flags.outputs.empty() && flags.run.skip_existing)
    refuse("--skip-existing looks for pictures, of which none is asked for; give -o FILE");
  if (flags.drop_checkpoint && (flags.outputs.empty() || flags.checkpoint.empty()))
    refuse("--drop-checkpoint needs --checkpoint FILE, which it removes, and -o FILE, which is then there");
}

/// Outputs by names that tell their format.
std::vector<std::string> named_outputs(const RenderFlags& flags) {
  std::vector<std::string> names = flags.outputs;
  for (std::string& name : names) name = named_output(name, flags.run.format);
  return names;
}

}  // namespace

bool has_display_output(const RenderFlags& flags) {
  return std::any_of(flags.outputs.begin(), flags.outputs.end(),
                     [&](const auto& output) { return is_display_output(output, flags.run.format); });
}

MemoryUse memory_use(const RenderRequest& request) {
  const RenderFlags& flags = request.flags;
  MemoryUse use;
  use.adaptive = request.settings.adaptive;
  use.alpha = request.settings.background.kind == Background::Kind::transparent;
  use.background_picture = request.settings.background.kind == Background::Kind::picture;
  for (const Layer& layer : request.layers) {
    use.layer_channels += layer.channel_count();
    use.error_layers = use.error_layers || layer.need == LayerNeed::error;
  }
  const LightSplit& split = request.settings.light_split;
  use.light_parts = split.ways.size() + (split.groups.empty() ? 0 : split.groups.size() + 1);
  // Groups have channels that no table lists, and every part may have an error.
  use.layer_channels += 3 * int(split.groups.empty() ? 0 : split.groups.size() + 1);
  if (use.error_layers) use.layer_channels += 3 * int(use.light_parts);
  use.denoise = request.denoiser != nullptr;
  use.display = has_display_output(flags);
  use.report = !flags.report.empty();
  use.half = flags.exr.half;
  use.gradients = flags.integrator == "gradient";
  use.splats = flags.integrator == "light" || flags.integrator == "path" || use.gradients;
  return use;
}

RenderRequest check_render_flags(const RenderFlags& given) {
  require_scene(given.run.scenes.empty() ? "" : given.run.scenes.front(), "render");
  check_outputs(given);
  check_standard_output(given);
  Stopwatch watch;
  RenderRequest request;
  request.flags = with_draft(given);
  const RenderFlags& flags = request.flags;
  request.flags.camera.ground = choose_ground(flags.background, flags.integrator);
  request.flags.camera.turns = flags.run.turntable.has_value();
  if (!flags.accelerator.empty()) find_by_name(accelerators(), "accelerator", flags.accelerator);
  request.settings = make_settings(flags);
  check_strict(flags, request.settings);
  request.settings.background = choose_background(flags.background, named_outputs(flags));
  request.progress = parse_progress(flags);
  request.layer_list = choose_layers(flags);
  request.layers = find_layers(request.layer_list);
  check_exr_flags(flags.exr, named_outputs(flags), !request.layers.empty());
  request.settings.light_split = choose_light_split(flags.light_groups, request.layers);
  if (!flags.denoise.empty()) request.denoiser = &find_denoiser(flags.denoise);
  MemoryLimit& limit = request.flags.import.memory;
  if (request.settings.width > 0) check_picture_size(request.settings, memory_use(request), limit);
  request.flags.surroundings.max_memory = limit.bytes;
  limit = leaving_room_for_pictures(limit, request.settings, memory_use(request));
  request.display = choose_display(flags);
  check_surroundings(flags.surroundings);
  parse_fog(flags.fog);
  request.check_seconds = watch.lap();
  return request;
}

}  // namespace vernier::apps
