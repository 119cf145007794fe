#include "apps/render_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "apps/denoising.h"
#include "apps/flags.h"
#include "core/base/error.h"
#include "core/base/names.h"
#include "core/base/text_file.h"
#include "core/image/image_io.h"
#include "scene/accel/accelerator.h"

namespace vernier::apps {
namespace {

/// Of the film (seven numbers of eight bytes a half), and the picture made from it.
double bytes_per_pixel(std::span<const Layer> layers) {
  int channels = 3;
  for (const Layer& layer : layers) channels += layer.channel_count();
  return Film::halves * 7 * sizeof(double) + double(channels) * sizeof(float);
}

/// A negative number would be taken for a large one.
void parse_seed(const std::string& text) {
  uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc{} || end != text.data() + text.size())
    throw Error(ErrorKind::usage, fmt::format("'{}' is not a whole number from 0 to 2^64 - 1", text));
}

void add_quality_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Picture and effort");
  command.add_option("--spp", flags.spp, "samples a pixel on average (64 unless --time or --error is given)")
      ->check(whole_number(1, 1 << 30))
      ->type_name("N");
  command.add_option("--time", flags.time, "stop rendering after this long: 90s, 10m, 1.5h")
      ->check(parsed_by(parse_seconds))
      ->type_name("TIME");
  command
      .add_option("--error", flags.error,
                  "stop when the picture's relative RMSE is this and surely no tenth more: 1%, 0.01")
      ->check(parsed_by(parse_fraction))
      ->type_name("ERROR");
  command
      .add_option("--adaptive", flags.adaptive, "spend samples where they lower the picture's error: on, off")
      ->check(CLI::IsMember({"on", "off"}))
      ->type_name("on|off")
      ->capture_default_str();
  command
      .add_option("--size,--resolution", flags.size, "of the picture (the camera's shape, 1280 pixels long)")
      ->check(parsed_by(parse_pixel_size))
      ->type_name("WxH");
  command.add_option("--crop", flags.crop, "render only this part")
      ->check(parsed_by(parse_pixel_rect))
      ->type_name("WxH+X+Y");
  command.add_option("--camera", flags.camera, "of the scene, by name or number (the first)")
      ->type_name("NAME|N");
  command.add_option("--seed", flags.seed, "of the random numbers")
      ->check(parsed_by(parse_seed))
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
  command.add_option("--max-depth", options.max_depth, "path vertices after the camera")
      ->check(whole_number(1, 65536))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--ambient", options.ambient, "whitted: radiance that reaches everything")
      ->check(real_number(0, 1e30))
      ->type_name("L")
      ->capture_default_str();
  command.add_option("--cutoff", options.cutoff, "whitted: smallest contribution that is still traced")
      ->check(real_number(0, 1e30))
      ->type_name("X")
      ->capture_default_str();
  command.add_option("--accelerator", flags.accelerator, "ray query structure; 'help' lists them")
      ->type_name("NAME");
  add_environment_flags(command, flags);
}

void add_output_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Output");
  command
      .add_option("--aov,--layers", flags.layers,
                  "layers of the .exr beside its colour: error,albedo,...; 'help' lists them, 'all' is all")
      ->type_name("LIST");
  command
      .add_option("--denoise", flags.denoise,
                  "filter the noise out before writing; 'help' lists the filters (docs/denoise.md)")
      ->type_name("FILTER");
  command.add_option("--exposure", flags.display.exposure, "stops, for PNG and JPEG")
      ->check(real_number(-100, 100))
      ->type_name("EV");
  command.add_option("--view", flags.display.view, "display view for PNG and JPEG; 'help' lists them")
      ->type_name("NAME");
  command.add_option("--ocio", flags.display.config, "OpenColorIO config ($OCIO, else a built-in one)")
      ->type_name("FILE");
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

/// The table as --aov takes it: name, channels in the file, meaning.
void print_layers() {
  for (const Layer& layer : layers())
    fmt::print("{:<10} {}\n{:10} channels {}\n", layer.name, layer.description, "",
               fmt::join(layer.channels.begin(), layer.channels.begin() + layer.channel_count(), ", "));
}

/// Only OpenEXR holds more than a picture's colour. Denoising brings the layers that it uses.
std::vector<Layer> choose_layers(const RenderFlags& flags) {
  if (!flags.layers.empty() && std::all_of(flags.outputs.begin(), flags.outputs.end(), is_display_file))
    throw Error(ErrorKind::usage, {}, "--aov",
                "only an .exr can hold layers; add -o FILE.exr, which may be given beside other outputs");
  std::string list = flags.layers;
  if (!flags.denoise.empty()) list += (list.empty() ? "" : ",") + std::string(layers_for_denoising);
  return find_layers(list);
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

std::unique_ptr<Integrator> make_integrator(const RenderFlags& flags) {
  const IntegratorEntry& entry = find_by_name(integrators(), "integrator", flags.integrator);
  IntegratorOptions options = flags.integrator_options;
  if (!flags.show.empty()) {
    if (entry.name != "raycast") throw Error(ErrorKind::usage, "--show needs --integrator raycast");
    std::vector<std::string> names(raycast_shows().begin(), raycast_shows().end());
    if (std::find(names.begin(), names.end(), flags.show) == names.end())
      throw_unknown_name("--show", flags.show, names);
    options.show = flags.show;
  }
  return entry.make(options);
}

RenderOptions make_options(const RenderFlags& flags) {
  RenderOptions options;
  options.seed = flags.seed;
  if (!flags.time.empty()) options.time_limit = parse_seconds(flags.time);
  if (!flags.error.empty()) options.target_error = parse_fraction(flags.error);
  options.adaptive = flags.adaptive == "on";
  options.spp = flags.spp.value_or(flags.time.empty() && flags.error.empty() ? 64 : 0);
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
  if (!needed && std::none_of(flags.outputs.begin(), flags.outputs.end(), is_display_file)) return display;
  const std::vector<std::string> views = display_views(display);
  if (!display.view.empty()) {
    if (std::find(views.begin(), views.end(), display.view) == views.end())
      throw_unknown_name("view", display.view, views);
    return display;
  }
  display.view = views.front();
  if (flags.integrator == "raycast")
    for (const auto& view : views)
      if (equal_ignoring_case(view, "raw")) display.view = view;
  return display;
}

/// A render may go on in the checkpoint that it came from.
void require_separate_outputs(const RenderFlags& flags) {
  std::vector<std::string> written = flags.outputs;
  written.insert(written.end(), {flags.stats, flags.report, flags.checkpoint});
  std::vector<std::string> read{flags.scene, flags.environment, flags.display.config};
  if (flags.resume != flags.checkpoint) read.push_back(flags.resume);
  require_separate_files(read, written);
}

}  // namespace

void add_environment_flags(CLI::App& command, RenderFlags& flags) {
  command.add_option("--env", flags.environment, "latitude-longitude picture of the surroundings (HDR, EXR)")
      ->type_name("FILE");
  command.add_option("--env-rotate", flags.environment_rotate, "degrees counter-clockwise seen from above")
      ->check(real_number(-1e6, 1e6))
      ->type_name("DEG");
  command.add_option("--env-scale", flags.environment_scale, "multiplies its radiance")
      ->check(real_number(0, 1e30))
      ->type_name("S");
}

std::shared_ptr<const EnvironmentDescription> read_environment(const RenderFlags& flags) {
  if (flags.environment.empty()) {
    if (flags.environment_rotate != 0 || flags.environment_scale != 1)
      throw Error(ErrorKind::usage, "--env-rotate and --env-scale need --env FILE");
    return nullptr;
  }
  auto environment = std::make_shared<EnvironmentDescription>();
  environment->picture = std::make_shared<const Image>(read_image(flags.environment));
  environment->rotation = std::remainder(flags.environment_rotate, 360.0f) * pi / 180;
  environment->scale = flags.environment_scale;
  return environment;
}

void surround(SceneDescription& scene, std::shared_ptr<const EnvironmentDescription> environment) {
  if (!environment) return;
  if (scene.environment)
    scene.notices.push_back(
        {Notice::Severity::info, "", "--env is used instead of the file's own environment"});
  scene.environment = std::move(environment);
}

void add_render_flags(CLI::App& command, RenderFlags& flags) {
  command
      .add_option("-o,--output", flags.outputs,
                  "picture: .exr (scene-linear), .png or .jpg (for display); may be given more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_scene_flags(command, flags.scene, flags.import);
  add_quality_flags(command, flags);
  add_integrator_flags(command, flags);
  add_output_flags(command, flags);
}

void check_picture_size(const RenderOptions& options, std::span<const Layer> layers) {
  const Crop& crop = options.crop;
  if (crop.width > 0 && (crop.width > options.width - crop.x || crop.height > options.height - crop.y))
    throw Error(ErrorKind::usage,
                fmt::format("--crop {}x{}+{}+{} reaches beyond the picture of {}x{}", crop.width, crop.height,
                            crop.x, crop.y, options.width, options.height));
  const double pixels =
      crop.width > 0 ? double(crop.width) * crop.height : double(options.width) * options.height;
  const double bytes = pixels * bytes_per_pixel(layers);
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (bytes > memory)
    throw Error(
        ErrorKind::memory,
        fmt::format("a picture of {} pixels needs {} of memory and there are {}; render parts with --crop",
                    format_count(pixels), format_bytes(bytes), format_bytes(memory)));
}

bool print_requested_list(const RenderFlags& flags) {
  if (flags.integrator == "help") {
    print_table(integrators());
  } else if (flags.accelerator == "help") {
    print_table(accelerators());
  } else if (flags.show == "help") {
    for (const auto& name : raycast_shows()) fmt::print("{}\n", name);
  } else if (flags.denoise == "help") {
    print_table(denoisers());
  } else if (flags.layers == "help") {
    print_layers();
  } else if (flags.display.view == "help") {
    DisplayOptions display = flags.display;
    display.view.clear();
    for (const auto& name : display_views(display)) fmt::print("{}\n", name);
  } else {
    return false;
  }
  return true;
}

RenderRequest check_render_flags(const RenderFlags& flags) {
  require_scene(flags.scene, "render");
  if (flags.outputs.empty())
    throw Error(ErrorKind::usage,
                "where to? Give -o FILE with .exr, .png or .jpg; see vernier render --help");
  RenderRequest request;
  request.flags = flags;
  request.integrator = make_integrator(flags);
  if (!flags.accelerator.empty()) find_by_name(accelerators(), "accelerator", flags.accelerator);
  request.options = make_options(flags);
  request.progress = parse_progress(flags);
  request.layers = choose_layers(flags);
  if (!flags.denoise.empty()) request.denoiser = &find_denoiser(flags.denoise);
  if (request.options.width > 0) check_picture_size(request.options, request.layers);
  request.display = choose_display(flags);
  require_separate_outputs(flags);
  for (const auto& path : flags.outputs) check_writable_image(path);
  for (const auto& path : {flags.stats, flags.report})
    if (!path.empty()) check_writable_text_file(path);
  request.environment = read_environment(flags);
  return request;
}

bool is_display_file(const std::string& path) {
  return !equal_ignoring_case(std::filesystem::path(path).extension().string(), ".exr");
}

}  // namespace vernier::apps
