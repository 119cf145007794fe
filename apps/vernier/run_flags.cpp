// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/run_flags.h"

#include <fmt/format.h>

#include <array>

#include "apps/vernier/flags.h"
#include "apps/vernier/frame_list.h"
#include "core/base/names.h"
#include "core/base/quantities.h"

namespace vernier::apps {
namespace {

constexpr const char* never = "never";

double parse_interval(const std::string& text) {
  if (text == never) return 0;
  if (text.find_first_of("0123456789") == std::string::npos) {
    const std::array<std::string, 1> words{never};
    if (const std::string nearest = nearest_name(text, words); !nearest.empty())
      throw Error(ErrorKind::usage, fmt::format("'{}' is no time; did you mean '{}'?", text, nearest));
  }
  return parse_seconds(text);
}

}  // namespace

void add_run_flags(CLI::App& command, RunFlags& flags) {
  const std::string group = command.option_defaults()->get_group();
  command.option_defaults()->group("Many pictures");
  command
      .add_option(
          "--frames", flags.frames,
          "pictures of an animation, or those of a turntable: 1-48, 1-48x2, 1,5,9; frame N is at N/fps "
          "seconds")
      ->check(parsed_by(parse_frames))
      ->type_name("A-B[xSTEP]|LIST");
  command.add_option("--fps", flags.fps, "frames a second of animation (24)")
      ->transform(real_number(1e-3, 1e6))
      ->type_name("N");
  command.add_option("--turntable", flags.turntable, "so many pictures from all around, at equal angles")
      ->transform(whole_number(1, 100'000))
      ->type_name("N");
  add_shutter_flag(command, flags.shutter);
  add_shutter_shape_flag(command, flags.shutter);
  command.add_flag("--skip-existing", flags.skip_existing,
                   "leave out pictures whose files are there and finished");
  command.add_flag("--keep-going", flags.keep_going,
                   "go on when one picture or scene fails; the exit code tells at the end");
  command.option_defaults()->group(group);
}

void add_jobs_flag(CLI::App& command, RunFlags& flags) {
  command
      .add_option("--jobs", flags.jobs,
                  "render what each line of this file says: scenes and flags, beside those given here; - is "
                  "standard input (docs/sequences.md)")
      ->type_name("FILE")
      ->group("Many pictures");
}

void add_preview_flags(CLI::App& command, RunFlags& flags) {
  command.add_flag("--draft", flags.draft,
                   "a look at it: --spp 8 --denoise nlm --texture-filter mip, unless others are given");
  command
      .add_option(
          "--write-every", flags.write_every,
          "write the picture so far as soon as all pixels have samples, and then this often: 2s, 1m, never "
          "(2s on a terminal)")
      ->check(parsed_by(parse_interval))
      ->type_name("TIME");
  command
      .add_option("--format", flags.format, "format of the picture that -o - writes: png, jpg or exr (png)")
      ->check([](const std::string& text) {
        static const std::array<std::string, 3> known{"png", "jpg", "exr"};
        if (std::find(known.begin(), known.end(), text) != known.end()) return std::string();
        return unknown_name_message("format", text, known);
      })
      ->type_name("NAME");
}

void check_run_flags(const RunFlags& flags, const TimeFlags& others) {
  const auto refuse = [](const char* problem) { throw Error(ErrorKind::usage, problem); };
  if (flags.fps && flags.turntable)
    refuse("--fps means nothing to --turntable, whose pictures show one moment; --at picks it");
  const bool has_neighbors = others.shows_motion && others.time_is_given;
  const bool counts_frames = has_neighbors || (!flags.shutter.shutter.empty() && others.time_is_given);
  if (flags.fps && flags.frames.empty() && !counts_frames)
    refuse("--fps needs --frames; without it --at takes seconds");
  if (!flags.shutter.shutter.empty() && !others.time_is_given && flags.frames.empty() && !flags.turntable)
    refuse(
        "--shutter blurs what moves, and without a time everything is at rest; add --frames, --at or "
        "--turntable");
  if (others.shows_motion && !others.time_is_given && flags.frames.empty() && !flags.turntable)
    refuse(
        "--aov motion is about the pictures before and after, and there are none; add --frames, --at or "
        "--turntable");
  if (!flags.frames.empty() && others.time_is_given && !flags.turntable)
    refuse("--frames and --at contradict each other: each says at what time the scene is posed");
}

std::optional<double> preview_interval(const RunFlags& flags, bool on_terminal) {
  constexpr double by_default = 2;
  if (flags.write_every == never) return std::nullopt;
  if (!flags.write_every.empty()) return parse_interval(flags.write_every);
  return on_terminal ? std::optional(by_default) : std::nullopt;
}

}  // namespace vernier::apps
