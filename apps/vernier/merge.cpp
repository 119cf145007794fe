// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "apps/vernier/commands.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "core/base/parallel.h"
#include "core/base/quantities.h"
#include "integrators/render/checkpoint.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct MergeFlags {
  std::vector<std::string> inputs;
  std::string output, layers;
  DisplayOptions display;
  ExrOptions exr;
  unsigned threads = 0;
  bool quiet = false;
};

/// Renders of one picture by different seeds, put together.
struct Merged {
  std::optional<RenderResult> result;
  RenderIdentity identity;  ///< without seed, build and platform
  std::map<uint64_t, std::string> files_by_seed;

  void add(const std::string& path) {
    Checkpoint checkpoint = read_checkpoint(path);
    const std::string seed = take(checkpoint.identity, "seed");
    if (seed.empty()) throw Error(ErrorKind::input, path, {}, "does not say its seed");
    take(checkpoint.identity, "build");  // machines may have their own
    take(checkpoint.identity, "platform");
    uint64_t number = 0;
    std::from_chars(seed.data(), seed.data() + seed.size(), number);
    const auto [same, is_new] = files_by_seed.emplace(number, path);
    if (!is_new)
      throw Error(ErrorKind::input, path, {},
                  fmt::format("has the seed {} of {}, so both hold the same samples; render parts with "
                              "different --seed",
                              seed, same->second));
    RenderResult& more = checkpoint.state->so_far;
    if (!result) {
      identity = std::move(checkpoint.identity);
      result = std::move(more);
      return;
    }
    require_same_render(path, checkpoint.identity, identity);
    if (more.film.width() != result->film.width() || more.film.height() != result->film.height() ||
        more.film.has_alpha() != result->film.has_alpha() || more.light.size() != result->light.size())
      throw Error(ErrorKind::input, path, {}, "is damaged: its picture is not of the size that it says");
    result->film.merge(more.film);
    for (size_t i = 0; i < more.light.size(); ++i) result->light[i].film.merge(more.light[i].film);
    result->samples += more.samples;
    result->seconds += more.seconds;
    result->bad_samples += more.bad_samples;
  }
};

/// Of a crop in its picture, as a render's identity tells it.
PicturePlace place_of(const RenderIdentity& identity) {
  const std::map<std::string, std::string> render(identity.begin(), identity.end());
  const auto crop = render.find("crop"), size = render.find("size");
  if (crop == render.end() || size == render.end()) return {};
  const PixelRect rect = parse_pixel_rect(crop->second);
  const PixelSize full = parse_pixel_size(size->second);
  return {rect.x, rect.y, full.width, full.height};
}

Metadata merged_metadata(const Merged& merged, const std::string& command_line) {
  Metadata metadata = result_metadata(*merged.result);
  metadata["vernier:command"] = command_line;
  const std::map<std::string, std::string> render(merged.identity.begin(), merged.identity.end());
  const std::pair<const char*, const char*> names[] = {{"vernier:sceneHash", "scene"},
                                                       {"vernier:integrator", "integrator"},
                                                       {"vernier:accelerator", "accelerator"},
                                                       {"vernier:size", "size"},
                                                       {"vernier:crop", "crop"}};
  for (const auto& [attribute, name] : names)
    if (const auto found = render.find(name); found != render.end()) metadata[attribute] = found->second;
  std::vector<uint64_t> seeds;
  for (const auto& [seed, file] : merged.files_by_seed) seeds.push_back(seed);
  metadata["vernier:seed"] = fmt::format("{}", fmt::join(seeds, " "));
  return metadata;
}

ExitCode run_merge(const MergeFlags& flags, const std::string& command_line) {
  if (print_requested_views(flags.display)) return ExitCode::done;
  if (flags.inputs.size() < 2)
    throw Error(ErrorKind::usage, "missing CHECKPOINT: two or more are merged; see vernier merge --help");
  if (flags.output.empty())
    throw Error(ErrorKind::usage, "missing -o FILE (.exr, .png, .jpg); see vernier merge --help");
  if (!flags.layers.empty() && is_display_file(flags.output))
    throw Error(ErrorKind::usage, {}, "--aov", "only an .exr can hold layers; name one with -o");
  const std::vector<Layer> chosen = find_film_layers(flags.layers);
  check_exr_flags(flags.exr, {flags.output}, !flags.layers.empty());
  check_writable_image(flags.output);
  const DisplayOptions display =
      is_display_file(flags.output) ? with_chosen_view(flags.display) : flags.display;
  const ThreadLimit threads(flags.threads);
  Merged merged;
  for (const auto& path : flags.inputs) merged.add(path);
  RenderResult& result = *merged.result;
  if (result.film.has_alpha()) require_alpha_fits(flags.output);
  result.error = estimate_error(result.film);
  LayeredImage picture = with_film_layers(result, chosen);
  picture.place = place_of(merged.identity);
  write_picture(flags.output, picture, merged_metadata(merged, command_line), display, flags.exr);
  if (!flags.quiet)
    fmt::print("{}\n",
               one_line(fmt::format("wrote {}: {}x{}, {:.4g} spp of {} renders{}", flags.output,
                                    picture.image.width, picture.image.height, samples_per_pixel(result),
                                    flags.inputs.size(), error_text(result.error))));
  return ExitCode::done;
}

}  // namespace

void register_merge(Program& program) {
  CLI::App* command =
      program.app.add_subcommand("merge", "Put renders of one picture by several seeds together");
  auto flags = std::make_shared<MergeFlags>();
  command->add_option("CHECKPOINT", flags->inputs, "two or more, of 'vernier render --checkpoint'")
      ->type_name("");
  command
      ->add_option("-o,--output", flags->output,
                   "picture of all their samples: .exr, or .png or .jpg for display")
      ->type_name("FILE");
  command
      ->add_option("--aov,--layers", flags->layers,
                   "layers beside the colour: error, samples, variance, half")
      ->type_name("LIST");
  add_display_flags(*command, flags->display);
  add_exr_flags(*command, flags->exr);
  add_threads_flag(*command, flags->threads);
  command->add_flag("-q,--quiet", flags->quiet, "say nothing but errors");
  command->footer(
      "Example: vernier render scene.glb -o a.exr --seed 1 --time 1h --checkpoint a.ckpt   (here)\n"
      "         vernier render scene.glb -o b.exr --seed 2 --time 1h --checkpoint b.ckpt   (there)\n"
      "         vernier merge a.ckpt b.ckpt -o c.exr --aov error");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_merge(*flags, program.command_line); };
  });
}

}  // namespace vernier::apps
