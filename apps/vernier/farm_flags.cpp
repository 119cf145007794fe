// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/farm_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <set>

#include "apps/vernier/flags.h"
#include "apps/vernier/frame_list.h"
#include "apps/vernier/picture_command.h"
#include "apps/vernier/picture_output.h"
#include "apps/vernier/run_plan.h"
#include "core/base/quantities.h"
#include "integrators/render/layers.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

/// Slurm's arrays go to 1,000 unless a cluster is set up for more.
constexpr int usual_most_parts = 1000;

/// Flags that are the script's to give to a part, or that say how it is written.
const std::set<std::string> own_flags{"--parts",  "--folder", "--rounds",  "--skip-missing",
                                      "--sbatch", "--submit", "--threads", "--skip-existing",
                                      "--frames", "--help"};
/// Of a still, also those that are shared out and those of the merge.
const std::set<std::string> seed_flags{"--spp", "--error", "--seed"};
const std::set<std::string> merge_flags{"--output", "--aov", "--exposure", "--view", "--ocio", "--quiet"};
/// What says something of one render that a part is not, and why it cannot be shared out.
const std::pair<const char*, const char*> refused_of_stills[] = {
    {"--denoise", "a merged picture is denoised by itself: give --aov half, then vernier denoise"},
    {"--draft", "a draft needs no farm; give --spp"},
    {"--stats", "each part would write it; render a part by itself for its statistics"},
    {"--report", "each part would write it; render a part by itself for its report"},
    {"--write-every", "parts write no picture; vernier farm status tells how far they are"},
    {"--keep-going", "a farm renders one picture"}};

/// Words that give flags to a command again.
std::vector<std::string> words_of(const std::vector<CommandFlag>& flags) {
  std::vector<std::string> words;
  for (const CommandFlag& flag : flags) {
    if (flag.values.empty()) words.push_back(flag.name);
    for (const std::string& value : flag.values) words.insert(words.end(), {flag.name, value});
  }
  return words;
}

/// Flags that were given and whose names `is_wanted`.
template <typename Predicate>
std::vector<CommandFlag> given(const CLI::App& command, const Predicate& is_wanted) {
  std::vector<CommandFlag> flags = flags_of(command);
  std::erase_if(flags, [&](const CommandFlag& flag) { return !flag.is_given || !is_wanted(flag.name); });
  return flags;
}

/// Beside the output: out.parts for out.exr, walk.parts for walk.####.exr.
std::string default_folder(const std::string& output) {
  const size_t special = std::min(output.find("##"), output.find('{'));
  std::string stem = special == std::string::npos ? fs::path(output).replace_extension().string()
                                                  : output.substr(0, special);
  while (!stem.empty() && std::string_view("._- ").find(stem.back()) != std::string_view::npos)
    stem.pop_back();
  if (stem.empty() || stem.back() == '/') stem += "frames";
  return stem + ".parts";
}

void require_one(const RunPlan& plan) {
  const auto refuse = [](const char* what) {
    throw Error(ErrorKind::usage, fmt::format("a farm renders one picture or one animation, not {}; plan one "
                                              "for each",
                                              what));
  };
  if (plan.scenes.size() > 1) refuse("several scenes");
  if (plan.all_variants) refuse("all variants");
  if (plan.all_cameras) refuse("all cameras");
  if (is_standard_stream(plan.scenes.front()))
    throw Error(ErrorKind::usage, "a farm's machines cannot read a scene from standard input; name its file");
  for (const FilePattern& output : plan.files.outputs) {
    if (is_standard_stream(output.text()))
      throw Error(ErrorKind::usage, "a farm writes no picture to standard output; name a file by -o");
    if (output.has(Placeholder::camera))
      throw Error(ErrorKind::usage, output.text(), {},
                  "a farm has one camera; put its name in place of {camera}");
  }
}

/// Frames, or sides of a turntable.
std::vector<int> frames_of(const RunPlan& plan) {
  std::vector<int> frames;
  for (const auto* numbers : {&plan.times, &plan.sides})
    for (const auto& number : *numbers)
      if (number) frames.push_back(*number);
  return frames;
}

/// Each part gets frames that follow each other.
FrameParts share_out(const std::vector<int>& frames, int parts) {
  FrameParts list;
  size_t begin = 0;
  for (int part = 1; part <= parts; ++part) {
    const auto count = size_t(share(int(frames.size()), part, parts));
    list.push_back(frames_text(std::span(frames).subspan(begin, count)));
    begin += count;
  }
  return list;
}

void plan_frames(FarmPlan& plan, const FarmFlags& flags, const CLI::App& command, const RunPlan& run) {
  if (flags.skip_missing)
    throw Error(ErrorKind::usage, "--skip-missing is for parts that are merged, and frames are not");
  const std::vector<int> frames = frames_of(run);
  plan.parts = flags.parts.value_or(std::min(int(frames.size()), usual_most_parts));
  if (plan.parts > int(frames.size()))
    throw Error(
        ErrorKind::usage,
        fmt::format("--parts {}: there are only {} frames; a single picture of an animation, by --at, "
                    "is shared out by seeds",
                    plan.parts, frames.size()));
  plan.frames = share_out(frames, plan.parts);
  const auto passed = given(command, [](const std::string& name) { return !own_flags.contains(name); });
  const auto words = words_of(passed);
  plan.render.insert(plan.render.end(), words.begin(), words.end());
}

/// Samples a pixel of all parts, and how often they are looked at.
void plan_samples(SeedParts& seeds, const FarmFlags& flags, int parts) {
  constexpr int default_spp = 64;
  const RenderFlags& render = flags.render;
  seeds.error = render.error;
  if (!render.error.empty()) {
    // Enough for each part to know its error, and for adaptive sampling to begin.
    constexpr int pilot_spp = 16;
    seeds.spp = pilot_spp * parts;
    if (render.spp) seeds.most_spp = *render.spp;
    if (seeds.most_spp > 0) seeds.spp = std::min(seeds.spp, seeds.most_spp);
    seeds.rounds = flags.rounds;
  } else {
    seeds.spp = render.spp.value_or(render.time.empty() ? default_spp : 0);
  }
  constexpr int least = 2;  // one in each half, so that there is an error
  if (seeds.spp > 0 && seeds.spp / parts < least)
    throw Error(ErrorKind::usage,
                fmt::format("--spp {} in {} parts is less than {} samples a pixel each; take more samples or "
                            "fewer --parts",
                            seeds.spp, parts, least));
}

void plan_seeds(FarmPlan& plan, const FarmFlags& flags, const CLI::App& command, const RunPlan& run) {
  if (!flags.parts) throw Error(ErrorKind::usage, "missing --parts N: how many machines render the picture");
  plan.parts = *flags.parts;
  if (plan.parts < 2) throw Error(ErrorKind::usage, "--parts 1 is no farm; 'vernier render' renders it");
  for (const auto& [name, reason] : refused_of_stills)
    if (!given(command, [name = name](const std::string& flag) { return flag == name; }).empty())
      throw Error(ErrorKind::usage, {}, name, reason);
  find_film_layers(flags.render.layers);  // or it throws: merging knows no other
  SeedParts& seeds = plan.seeds;
  if (command.count("--seed") > 0) seeds.first_seed = flags.render.seed;
  if (command.count("--rounds") > 0 && flags.render.error.empty())
    throw Error(ErrorKind::usage, "--rounds needs --error, for which the later ones are");
  constexpr auto last_seed = uint64_t(std::numeric_limits<int64_t>::max());  // that a shell can count to
  if (seeds.first_seed > last_seed - uint64_t(plan.parts))
    throw Error(ErrorKind::usage, fmt::format("--seed: the last part's would be beyond {}", last_seed));
  seeds.skip_missing = flags.skip_missing;
  plan_samples(seeds, flags, plan.parts);
  const auto passed = words_of(given(command, [](const std::string& name) {
    return !own_flags.contains(name) && !seed_flags.contains(name) &&
           (!merge_flags.contains(name) || name == "--quiet");
  }));
  plan.render.insert(plan.render.end(), passed.begin(), passed.end());
  std::vector<CommandFlag> merged =
      given(command, [](const std::string& name) { return merge_flags.contains(name); });
  const PictureName picture{stem_of(run.scenes.front()), "", run.variants.front(), {}};
  for (CommandFlag& flag : merged)
    if (flag.name == "--output")
      for (std::string& value : flag.values) value = FilePattern(value).fill(picture);
  seeds.merge = words_of(merged);
  if (!seeds.error.empty()) seeds.merge.insert(seeds.merge.end(), {"--error", seeds.error});
  if (seeds.skip_missing) seeds.merge.emplace_back("--skip-missing");
  plan.output = run.files.outputs.front().fill(picture);
}

}  // namespace

void add_farm_flags(CLI::App& command, FarmFlags& flags, bool is_slurm) {
  command
      .add_option("--parts", flags.parts,
                  "so many renders of a still, each by a seed of its own, to which all samples and the error "
                  "are shared out; or of an animation, by frames (one each)")
      ->transform(whole_number(1, 100'000))
      ->type_name("N");
  command.add_option("--folder", flags.folder, "for the parts and their logs (out.parts for -o out.exr)")
      ->type_name("DIR");
  command
      .add_option(
          "--rounds", flags.rounds,
          "with --error: so often parts are rendered and merged, each time up to what the merge before "
          "has found to be needed")
      ->transform(whole_number(1, 10))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--skip-missing", flags.skip_missing, "merge what is there when parts have failed");
  if (is_slurm) {
    command
        .add_option("--sbatch", flags.sbatch,
                    "an option for sbatch, such as --sbatch=--time=2:00:00; may be given more than once")
        ->type_name("OPTION")
        ->allow_extra_args(false);
    command.add_flag("--submit", flags.submit,
                     "hand the script to Slurm instead of printing it; it is kept in the folder");
  }
  command
      .add_option("--checkpoint-every", flags.render.checkpoint_every,
                  "how often parts are saved: 60s, 10m, 1h")
      ->check(parsed_by(parse_seconds))
      ->type_name("TIME")
      ->capture_default_str();
  add_render_flags(command, flags.render);
}

FarmPlan make_farm_plan(const FarmFlags& flags, const CLI::App& command) {
  const RenderRequest request = check_render_flags(flags.render);
  const RunPlan run = make_plan(request.flags);
  require_one(run);
  require_readable(run.scenes.front());
  check_files(request.flags, run);
  read_surroundings(request.flags.surroundings);  // or it throws here rather than in every part
  read_background_picture(request.flags.background, request.flags.import.memory.bytes);
  FarmPlan plan;
  plan.work = fs::current_path().string();
  plan.threads = flags.render.threads;
  plan.sbatch = flags.sbatch;
  plan.output = flags.render.outputs.front();
  plan.folder = flags.folder.empty() ? default_folder(plan.output) : flags.folder;
  plan.render.push_back(run.scenes.front());
  if (frames_of(run).empty())
    plan_seeds(plan, flags, command, run);
  else
    plan_frames(plan, flags, command, run);
  return plan;
}

}  // namespace vernier::apps
