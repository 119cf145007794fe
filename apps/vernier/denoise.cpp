// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/vernier/commands.h"
#include "apps/vernier/denoising.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/render_options.h"
#include "core/base/parallel.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct DenoiseFlags {
  std::string input, output, filter = std::string(denoisers().front().name);
  unsigned threads = 0;
  DisplayOptions display;
  ExrOptions exr;
  bool quiet = false;
};

/// What of a noisy picture goes into the denoised one's file. Alpha is not filtered.
LayeredImage color_and_reliability(const LayeredImage& noisy) {
  LayeredImage picture = color_and_alpha(noisy);
  picture.metadata = noisy.metadata;
  if (const auto unreliable = noisy.single("error.unreliable"))
    picture.append(*unreliable, {"error.unreliable"});
  return picture;
}

ExitCode run_denoise(const DenoiseFlags& flags, const std::string& command_line) {
  if (print_requested_denoisers(flags.filter) || print_requested_views(flags.display)) return ExitCode::done;
  if (flags.input.empty()) throw Error(ErrorKind::usage, "missing IN (.exr); see vernier denoise --help");
  if (flags.output.empty())
    throw Error(ErrorKind::usage, "missing -o FILE (.exr, .png, .jpg); see vernier denoise --help");
  const Denoiser& denoiser = find_denoiser(flags.filter);
  check_exr_flags(flags.exr, {flags.output}, true);
  check_writable_image(flags.output);
  const DisplayOptions display =
      is_display_file(flags.output) ? with_chosen_view(flags.display) : flags.display;
  const ThreadLimit threads(flags.threads);
  const LayeredImage noisy = read_layers(flags.input);
  if (!noisy.linear)
    throw Error(ErrorKind::input, flags.input, {},
                "holds display values; expected scene-linear ones, as in .exr");
  require_alpha_fits(noisy, flags.output);
  const Denoised denoised = denoise(noisy, denoiser);
  LayeredImage picture = color_and_reliability(noisy);
  replace_color(picture, denoised);
  Metadata& metadata = picture.metadata;
  for (const auto& [name, value] : denoised_metadata(denoiser, denoised.error)) metadata[name] = value;
  metadata["vernier:denoiseCommand"] = command_line;
  write_picture(flags.output, picture, metadata, display, flags.exr);
  if (!flags.quiet)
    fmt::print("{}\n", one_line(fmt::format("wrote {}: {}x{}, {}", flags.output, picture.image.width,
                                            picture.image.height, denoised_text(denoiser, denoised.error))));
  return ExitCode::done;
}

}  // namespace

void register_denoise(Program& program) {
  CLI::App* command = program.app.add_subcommand("denoise", "Filter the noise out of a picture");
  auto flags = std::make_shared<DenoiseFlags>();
  command
      ->add_option("IN", flags->input,
                   "scene-linear picture, best with --aov error,half,albedo,normal,coverage")
      ->type_name("");
  command->add_option("-o,--output", flags->output, "denoised picture: .exr, or .png or .jpg for display")
      ->type_name("FILE");
  command->add_option("--filter", flags->filter, "'help' lists them")
      ->type_name("NAME")
      ->capture_default_str();
  add_display_flags(*command, flags->display);
  add_exr_flags(*command, flags->exr);
  add_threads_flag(*command, flags->threads);
  command->add_flag("-q,--quiet", flags->quiet, "say nothing but errors");
  command->footer(
      "Example: vernier render scene.glb -o a.exr --aov error,half,albedo,normal,coverage --spp 16\n"
      "         vernier denoise a.exr -o b.exr");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_denoise(*flags, program.command_line); };
  });
}

}  // namespace vernier::apps
