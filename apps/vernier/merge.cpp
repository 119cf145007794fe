// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "apps/vernier/commands.h"
#include "apps/vernier/display_flags.h"
#include "apps/vernier/exr_flags.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/missing_text.h"
#include "apps/vernier/outputs.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "core/base/atomic_file.h"
#include "core/base/parallel.h"
#include "integrators/render/error_goal.h"
#include "integrators/render/layers.h"
#include "integrators/render/merge.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct MergeFlags {
  std::vector<std::string> inputs, outputs;
  std::string layers, error, goal;
  bool skip_missing = false;
  DisplayOptions display;
  ExrOptions exr;
  unsigned threads = 0;
  bool quiet = false;
};

bool any_is_display_file(const MergeFlags& flags) {
  return std::any_of(flags.outputs.begin(), flags.outputs.end(), is_display_file);
}

void check(const MergeFlags& flags) {
  if (flags.inputs.size() < 2)
    throw Error(ErrorKind::usage, "missing CHECKPOINT: two or more are merged; see vernier merge --help");
  if (flags.outputs.empty())
    throw Error(ErrorKind::usage, "missing -o FILE (.exr, .png, .jpg); see vernier merge --help");
  if (!flags.layers.empty() && std::all_of(flags.outputs.begin(), flags.outputs.end(), is_display_file))
    throw Error(ErrorKind::usage, {}, "--aov", "only an .exr can hold layers; name one with -o");
  if (!flags.goal.empty() && flags.error.empty())
    throw Error(ErrorKind::usage, "--goal needs --error, which says what the goal is");
  std::vector<std::string> written = flags.outputs;
  written.push_back(flags.goal);
  require_separate_files(flags.inputs, written);
  for (const std::string& output : flags.outputs) check_writable_image(output);
  if (!flags.goal.empty()) check_writable(flags.goal);
}

/// The first few of `names`.
std::string few(const std::vector<std::string>& names) {
  constexpr size_t most = 10;
  const size_t count = std::min(names.size(), most);
  const std::string more =
      names.size() > count ? fmt::format(" and {} more", names.size() - count) : std::string();
  return fmt::format("{}{}", fmt::join(names.begin(), names.begin() + std::ptrdiff_t(count), ", "), more);
}

/// The checkpoints that are there. Others are named, and refused unless they may be missing.
std::vector<std::string> present_inputs(const MergeFlags& flags) {
  std::vector<std::string> present, missing;
  for (const std::string& file : flags.inputs) {
    std::error_code error;
    (std::filesystem::exists(file, error) ? present : missing).push_back(file);
  }
  if (missing.empty()) return present;
  const std::string problem =
      fmt::format("{} of {} checkpoints {} not there: {}", missing.size(), flags.inputs.size(),
                  missing.size() == 1 ? "is" : "are", few(missing));
  if (!flags.skip_missing || present.empty())
    throw Error(ErrorKind::input,
                present.empty() ? problem : problem + "; render them, or take the others by --skip-missing");
  if (!flags.quiet)
    fmt::print(stderr, "{}\n", describe({Notice::Severity::warning, {}, problem + "; merging the others"}));
  return present;
}

/// Samples a pixel that all renders together should have for the error asked for; 0: it is reached.
int goal_of(const RenderResult& result, double asked) {
  const double needed = std::ceil(samples_for_error(result.error, samples_per_pixel(result), asked));
  return int(std::min(needed, double(std::numeric_limits<int>::max())));
}

/// Whether the error asked for is reached, after the error.
std::string goal_text(double asked, int goal, const MissingEstimate& missing) {
  if (exceeds(missing, asked))
    return fmt::format("; the error of {:.3g} % is not reached, for more than that is missing", 100 * asked);
  if (goal == 0) return "";
  return fmt::format("; the error of {:.3g} % needs about {} spp", 100 * asked, goal);
}

ExitCode run_merge(const MergeFlags& flags, const std::string& command_line) {
  if (print_requested_views(flags.display)) return ExitCode::done;
  check(flags);
  const std::vector<Layer> chosen = find_film_layers(flags.layers);
  check_exr_flags(flags.exr, flags.outputs, !flags.layers.empty());
  const DisplayOptions display = any_is_display_file(flags) ? with_chosen_view(flags.display) : flags.display;
  const ThreadLimit threads(flags.threads);
  const std::vector<std::string> inputs = present_inputs(flags);
  Merged merged;
  for (const auto& path : inputs) merged.add(path);
  const RenderResult& result = merged.result();
  if (result.film.has_alpha())
    for (const std::string& output : flags.outputs) require_alpha_fits(output);
  LayeredImage picture = merged.picture(chosen);
  picture.metadata["vernier:command"] = command_line;
  Outputs outputs;
  for (const std::string& output : flags.outputs)
    outputs.attempt([&] { write_picture(output, picture, picture.metadata, display, flags.exr); });
  std::string told = error_text(result.error) + missing_text(result.missing);
  if (!flags.error.empty()) {
    const double asked = parse_fraction(flags.error);
    const int goal = goal_of(result, asked);
    told += goal_text(asked, goal, result.missing);
    if (!flags.goal.empty()) outputs.attempt([&] { write_file(flags.goal, fmt::format("{}\n", goal)); });
  }
  if (outputs.have_failed()) return ExitCode::input;
  if (!flags.quiet)
    fmt::print("{}\n",
               one_line(fmt::format("wrote {}: {}x{}, {:.4g} spp of {} renders{}",
                                    fmt::join(flags.outputs, ", "), picture.image.width, picture.image.height,
                                    samples_per_pixel(result), inputs.size(), told)));
  return ExitCode::done;
}

void add_merge_flags(CLI::App& command, MergeFlags& flags) {
  command.add_option("CHECKPOINT", flags.inputs, "two or more, of 'vernier render --checkpoint'")
      ->type_name("");
  command
      .add_option(
          "-o,--output", flags.outputs,
          "picture of all their samples: .exr, or .png or .jpg for display; may be given more than once")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option("--aov,--layers", flags.layers, "layers beside the colour: error, samples, variance, half")
      ->type_name("LIST");
  command.add_flag("--skip-missing", flags.skip_missing, "merge what is there when checkpoints are missing");
  command
      .add_option("--error", flags.error,
                  "say how many samples a pixel the picture needs for this relative RMSE: 1%, 0.01")
      ->check(parsed_by(parse_fraction))
      ->type_name("ERROR");
  command.add_option("--goal", flags.goal, "write that number here; 0 when the error is reached")
      ->type_name("FILE");
  add_display_flags(command, flags.display);
  add_exr_flags(command, flags.exr);
  add_threads_flag(command, flags.threads);
  command.add_flag("-q,--quiet", flags.quiet, "say nothing but errors");
}

}  // namespace

void register_merge(Program& program) {
  CLI::App* command =
      program.app.add_subcommand("merge", "Put renders of one picture by several seeds together");
  auto flags = std::make_shared<MergeFlags>();
  add_merge_flags(*command, *flags);
  command->footer(
      "Example: vernier render scene.glb -o a.exr --seed 1 --time 1h --checkpoint a.ckpt   (here)\n"
      "         vernier render scene.glb -o b.exr --seed 2 --time 1h --checkpoint b.ckpt   (there)\n"
      "         vernier merge a.ckpt b.ckpt -o c.exr --aov error");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_merge(*flags, program.command_line); };
  });
}

}  // namespace vernier::apps
