// SPDX-License-Identifier: Apache-2.0
#include "apps/farm/farm_status.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "apps/farm/farm_plan.h"
#include "apps/vernier/file_pattern.h"
#include "apps/vernier/frame_list.h"
#include "apps/vernier/picture_output.h"
#include "core/base/quantities.h"
#include "integrators/render/checkpoint.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

constexpr size_t most_lines = 12;

/// "3 m 10 s ago", of when a file was written.
std::string age_of(const std::string& file) {
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  if (error) return "unknown";
  const std::chrono::duration<double> age = fs::file_time_type::clock::now() - written;
  return format_seconds(std::max(0.0, std::floor(age.count()))) + " ago";
}

/// The lines, or as many as one likes to read.
std::string shortened(const std::vector<std::string>& lines) {
  std::string text;
  for (size_t i = 0; i < std::min(lines.size(), most_lines); ++i) text += "  " + lines[i] + "\n";
  if (lines.size() > most_lines) text += fmt::format("  and {} more\n", lines.size() - most_lines);
  return text;
}

/// Samples a pixel that all parts go on to in the round that they are in; 0: only their time limits them.
int wanted_samples(const FarmPlan& plan, const std::string& folder) {
  int wanted = plan.seeds.spp;
  for (int round = 2; round <= plan.seeds.rounds; ++round) {
    int goal = 0;
    if (std::ifstream(fmt::format("{}/goal.{}", folder, round)) >> goal && goal > 0) wanted = goal;
  }
  return plan.seeds.most_spp > 0 ? std::min(wanted, plan.seeds.most_spp) : wanted;
}

/// What the parts that are there have together.
struct Sum {
  double samples_per_pixel = 0;
  double squares = 0;         ///< of each part's error times its samples
  bool is_known = true;       ///< whether all parts know their error
  int done = 0, started = 0;  ///< parts

  void add(const CheckpointSummary& part) {
    samples_per_pixel += part.samples_per_pixel;
    is_known = is_known && part.rel_rmse;
    squares += std::pow(part.rel_rmse.value_or(0) * part.samples_per_pixel, 2);
    ++started;
  }
  /// Errors of independent pictures, weighted as they are merged.
  std::string error_text() const {
    if (!is_known || started == 0) return "";
    return fmt::format(", error about {:.3g} %", 100 * std::sqrt(squares) / samples_per_pixel);
  }
};

/// One part that is there: added to `sum`, and told of in `open` unless it is done.
void look_at_part(const std::string& file, const std::string& name, int its_share, Sum& sum,
                  std::vector<std::string>& open) {
  const CheckpointSummary part = read_checkpoint_summary(file);
  sum.add(part);
  // Adaptive sampling rounds to whole samples.
  if (its_share > 0 && part.samples_per_pixel > its_share - 0.5)
    ++sum.done;
  else
    open.push_back(fmt::format("{}: {:.4g}{} samples a pixel, written {}", name, part.samples_per_pixel,
                               its_share > 0 ? fmt::format(" of {}", its_share) : "", age_of(file)));
}

std::string seeds_status(const FarmPlan& plan, const std::string& folder) {
  const int wanted = wanted_samples(plan, folder);
  Sum sum;
  std::vector<std::string> open, missing;
  for (int part = 1; part <= plan.parts; ++part) {
    const std::string file = fmt::format("{}/part.{}.ckpt", folder, part);
    const std::string name = fmt::format("part {}", part);
    std::error_code error;
    if (!fs::exists(file, error)) {
      missing.push_back(fmt::format("{}", part));
      continue;
    }
    try {
      look_at_part(file, name, share(wanted, part, plan.parts), sum, open);
    } catch (const Error& damage) {
      ++sum.started;
      sum.is_known = false;
      open.push_back(fmt::format("{}: {}", name, damage.what()));
    }
  }
  if (!missing.empty())
    open.insert(open.begin(), fmt::format("not begun: {:.200}", fmt::format("{}", fmt::join(missing, ", "))));
  return fmt::format("{}: {} parts by seeds from {}\n{:.6g}{} samples a pixel{}{}\n", plan.output, plan.parts,
                     plan.seeds.first_seed, sum.samples_per_pixel,
                     wanted > 0 ? fmt::format(" of {}", wanted) : "", sum.error_text(),
                     plan.seeds.error.empty() ? "" : fmt::format("; {} is asked for", plan.seeds.error)) +
         // Only the scheduler knows whether a part's time is over.
         (wanted > 0 ? fmt::format("{} parts done, {} begun, {} not begun\n", sum.done,
                                   sum.started - sum.done, missing.size())
                     : fmt::format("{} parts begun, {} not begun\n", sum.started, missing.size())) +
         shortened(open);
}

std::string frames_status(const FarmPlan& plan, const std::string& folder) {
  const FilePattern pictures((fs::path(plan.work) / plan.output).string()),
      checkpoints(folder + "/{frame}.ckpt");
  std::vector<std::string> open;
  int done = 0, begun = 0, count = 0;
  for (const std::string& frames : plan.frames)
    for (const int frame : parse_frames(frames)) {
      ++count;
      const PictureName name{"", "", "", frame};
      const std::string file = checkpoints.fill(name);
      std::error_code error;
      if (is_finished_picture(pictures.fill(name))) {
        ++done;
      } else if (fs::exists(file, error)) {
        ++begun;
        open.push_back(fmt::format("frame {}: {:.4g} samples a pixel, written {}", frame,
                                   read_checkpoint_summary(file).samples_per_pixel, age_of(file)));
      }
    }
  return fmt::format("{}: {} frames in {} parts\n{} frames done, {} begun, {} not begun\n", plan.output,
                     count, plan.parts, done, begun, count - done - begun) +
         shortened(open);
}

}  // namespace

std::string farm_status(const std::string& folder) {
  const FarmPlan plan = read_farm_plan(folder + "/farm.json");
  return plan.is_animation() ? frames_status(plan, folder) : seeds_status(plan, folder);
}

}  // namespace vernier::apps
