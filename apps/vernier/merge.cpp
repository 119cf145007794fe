// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "apps/vernier/commands.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "core/base/parallel.h"
#include "integrators/render/layers.h"
#include "integrators/render/merge.h"
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
  const RenderResult& result = merged.result();
  if (result.film.has_alpha()) require_alpha_fits(flags.output);
  LayeredImage picture = merged.picture(chosen);
  picture.metadata["vernier:command"] = command_line;
  write_picture(flags.output, picture, picture.metadata, display, flags.exr);
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
