// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "apps/vernier/commands.h"
#include "apps/vernier/denoising.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/outputs.h"
#include "core/base/parallel.h"
#include "core/base/quantities.h"
#include "integrators/render/picture.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct DevelopFlags {
  std::string input, denoise, layer, background;
  std::vector<std::string> outputs;
  DisplayOptions display;
  ExrOptions exr;
  unsigned threads = 0;
  bool quiet = false;
};

/// The layer `name` in place of the colour.
Image layer_as_color(const LayeredImage& picture, const std::string& name, const std::string& path) {
  if (const auto layer = picture.layer(name)) return *layer;
  const auto single = picture.single(name);
  if (!single)
    throw Error(ErrorKind::usage, path, "--layer",
                fmt::format("has no layer '{}'; there are the channels {}", name,
                            fmt::join(picture.channel_names, ", ")));
  Image gray(single->width, single->height, 3);
  for (size_t i = 0; i < gray.values.size(); ++i) gray.values[i] = single->values[i / 3];
  return gray;
}

/// Puts the colour that was asked for behind a transparent picture, which then is no more.
void put_behind(LayeredImage& picture, const DevelopFlags& flags) {
  const auto alpha = picture.single("A");
  if (!alpha)
    throw Error(ErrorKind::usage, flags.input, "--background",
                flags.layer.empty() ? "has no alpha, so nothing behind it would show"
                                    : "is for the colour, and --layer shows something else");
  const auto [r, g, b] = parse_color(flags.background);
  Image color = picture.rgb();
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      const float through = 1 - *alpha->pixel(x, y);
      float* value = color.pixel(x, y);
      for (const float behind : {r, g, b}) *value++ += through * behind;
    }
  picture = {std::move(color), {"R", "G", "B"}, {}, true};
}

void require_arguments(const DevelopFlags& flags) {
  if (flags.input.empty()) throw Error(ErrorKind::usage, "missing IN (.exr); see vernier develop --help");
  if (flags.outputs.empty())
    throw Error(ErrorKind::usage, "missing -o FILE (.png, .jpg, .exr); see vernier develop --help");
  if (!flags.layer.empty() && !flags.denoise.empty())
    throw Error(ErrorKind::usage, {}, "--denoise", "filters the colour, and --layer shows something else");
  require_separate_files({flags.input, flags.display.config}, flags.outputs);
  check_exr_flags(flags.exr, flags.outputs, false);
  for (const auto& output : flags.outputs) check_writable_image(output);
}

ExitCode run_develop(const DevelopFlags& flags, const std::string& command_line) {
  if (print_requested_denoisers(flags.denoise) || print_requested_views(flags.display)) return ExitCode::done;
  require_arguments(flags);
  const Denoiser* denoiser = flags.denoise.empty() ? nullptr : &find_denoiser(flags.denoise);
  DisplayOptions display = flags.display;
  if (std::any_of(flags.outputs.begin(), flags.outputs.end(), is_display_file))
    display = with_chosen_view(display);
  const ThreadLimit threads(flags.threads);

  LayeredImage picture = read_layers(flags.input);
  if (!picture.linear)
    throw Error(ErrorKind::input, flags.input, {},
                "holds display values already; expected scene-linear ones, as in .exr");
  Metadata metadata = std::move(picture.metadata);
  metadata["vernier:developCommand"] = command_line;
  if (!flags.layer.empty()) metadata["vernier:layer"] = flags.layer;
  std::string done;
  if (!flags.layer.empty()) {
    picture = {layer_as_color(picture, flags.layer, flags.input), {"R", "G", "B"}, {}, true};
  } else if (denoiser) {
    const Denoised denoised = denoise(picture, *denoiser);
    for (const auto& [name, value] : denoised_metadata(*denoiser, denoised.error)) metadata[name] = value;
    replace_color(picture, denoised);
    done = ", " + denoised_text(*denoiser, denoised.error);
  }
  picture = color_and_alpha(picture);
  if (!flags.background.empty()) put_behind(picture, flags);
  for (const auto& output : flags.outputs) require_alpha_fits(picture, output);

  Outputs outputs;
  for (const auto& output : flags.outputs) {
    if (!outputs.attempt([&] { write_picture(output, picture, metadata, display, flags.exr); }) ||
        flags.quiet)
      continue;
    const std::string view = is_display_file(output) ? fmt::format(", view {}", display.view) : "";
    fmt::print("{}\n", one_line(fmt::format("wrote {}: {}x{}{}{}", output, picture.image.width,
                                            picture.image.height, view, done)));
  }
  return outputs.have_failed() ? ExitCode::input : ExitCode::done;
}

}  // namespace

void register_develop(Program& program) {
  CLI::App* command =
      program.app.add_subcommand("develop", "Make a picture for display of a scene-linear one");
  auto flags = std::make_shared<DevelopFlags>();
  command->add_option("IN", flags->input, "scene-linear picture: rendered, denoised, merged")->type_name("");
  command->add_option("-o,--output", flags->outputs, "picture: .png or .jpg; .exr stays scene-linear")
      ->type_name("FILE")
      ->allow_extra_args(false);
  add_display_flags(*command, flags->display);
  add_exr_flags(*command, flags->exr);
  command->add_option("--denoise", flags->denoise, "filter the noise out first; 'help' lists the filters")
      ->type_name("FILTER");
  command->add_option("--layer", flags->layer, "show this layer of the file instead of its colour")
      ->type_name("NAME");
  command
      ->add_option("--background", flags->background,
                   "put this behind a transparent picture: sRGB '#rrggbb' or scene-linear R,G,B")
      ->check(parsed_by(parse_color))
      ->type_name("COLOUR");
  add_threads_flag(*command, flags->threads);
  command->add_flag("-q,--quiet", flags->quiet, "say nothing but errors");
  command->footer(
      "Example: vernier develop a.exr -o a.png --exposure 1.5 --view neutral\n"
      "         vernier develop a.exr -o a.png --denoise nlm");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_develop(*flags, program.command_line); };
  });
}

}  // namespace vernier::apps
