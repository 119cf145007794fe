// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/vernier/commands.h"
#include "apps/vernier/comparison.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/messages.h"
#include "core/display/colormap.h"
#include "core/image/image_io.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct CompareFlags {
  std::string picture, reference, heatmap;
  std::vector<std::string> fail;
  bool json = false, no_flip = false;
  ComparisonOptions options;
};

Json to_json(const BiasTest& bias) {
  return {{"level", bias.level},
          {"block", bias.block},
          {"different", bias.different()},
          {"blocks_tested", bias.tested},
          {"blocks_differing", bias.differing},
          {"pixels_not_finite", bias.not_finite},
          {"pixels_unreliable", bias.unreliable},
          {"smallest_p", bias.smallest_p},
          {"smallest_p_at", {bias.worst_x, bias.worst_y}},
          {"mean_difference", bias.mean_difference},
          {"mean_difference_error", bias.mean_error},
          {"mean_p", bias.mean_p}};
}

Json to_json(const CompareFlags& flags, const Comparison& comparison,
             const std::vector<std::string>& failed) {
  const ImageDifference& d = comparison.difference;
  Json json{{"picture", flags.picture},
            {"reference", flags.reference},
            {"width", comparison.width},
            {"height", comparison.height},
            {"values", comparison.linear ? "linear" : "display"},
            {"relmse_epsilon", relative_error_epsilon},
            {"psnr_peak", comparison.peak},
            {"largest_at", {d.largest_x, d.largest_y}},
            {"mean", d.mean},
            {"reference_mean", d.reference_mean}};
  // JSON has no infinity: the decibels of equal pictures are null.
  for (const Metric& metric : metrics())
    if (const auto value = metric.value(comparison)) json["metrics"][std::string(metric.name)] = *value;
  if (comparison.flip) {
    json["flip"] = {{"pixels_per_degree", flip_pixels_per_degree}};
    if (comparison.linear)
      json["flip"].update({{"start_exposure", comparison.flip->start_exposure},
                           {"stop_exposure", comparison.flip->stop_exposure},
                           {"exposures", comparison.flip->exposures}});
  }
  if (comparison.shown) json["shown"] = *comparison.shown;
  if (comparison.bias) json["bias"] = to_json(*comparison.bias);
  json["failed"] = failed;
  return json;
}

/// What a metric's own line says beside its description.
std::string note(const Metric& metric, const Comparison& comparison) {
  const ImageDifference& d = comparison.difference;
  if (metric.name == "psnr") return fmt::format(", from a peak of {:.6g}", comparison.peak);
  if (metric.name == "largest") return fmt::format(", at ({}, {})", d.largest_x, d.largest_y);
  if (metric.name == "flip" && comparison.linear)
    return fmt::format(", HDR, largest over {} exposures from {:+.2f} to {:+.2f} EV",
                       comparison.flip->exposures, comparison.flip->start_exposure,
                       comparison.flip->stop_exposure);
  if (metric.name == "differing")
    return fmt::format(", of {} of {}x{} pixels, {} not to be trusted left out, false discovery rate {:.6g}",
                       comparison.bias->tested, comparison.bias->block, comparison.bias->block,
                       comparison.bias->unreliable, comparison.bias->level);
  return {};
}

void print_text(const CompareFlags& flags, const Comparison& comparison) {
  const auto line = [](std::string_view name, const std::string& text) {
    fmt::print("{:<12} {}\n", name, text);
  };
  fmt::print("{}\n", one_line(fmt::format("{} against {}, {}x{}, {}", flags.picture, flags.reference,
                                          comparison.width, comparison.height,
                                          comparison.linear ? "linear light" : "display values")));
  for (const Metric& metric : metrics())
    if (const auto value = metric.value(comparison))
      line(metric.name, fmt::format("{:<12.6g} {}{}", *value, metric.description, note(metric, comparison)));
  const auto rgb = [](const std::array<double, 3>& v) {
    return fmt::format("{:.6g} {:.6g} {:.6g}", v[0], v[1], v[2]);
  };
  if (comparison.shown)
    line("pixels", fmt::format("{:<12.6g} part that shows a surface, which mse to largest and means are of",
                               *comparison.shown));
  line("mean x", rgb(comparison.difference.mean));
  line("mean r", rgb(comparison.difference.reference_mean));
  if (!comparison.bias) return;
  line("mean x-r", fmt::format("{}, standard error {}", rgb(comparison.bias->mean_difference),
                               rgb(comparison.bias->mean_error)));
  const bool different = comparison.bias->different();
  if (comparison.denoised)
    line("bias", different ? "the pictures differ by more than the errors after denoising that they tell"
                           : "no difference found beyond the errors after denoising that they tell");
  else
    line("bias",
         different ? "the pictures have different expectations" : "no difference of expectation found");
}

ExitCode run_compare(const CompareFlags& flags) {
  if (flags.picture.empty() || flags.reference.empty())
    throw Error(ErrorKind::usage, "missing X or R, a picture and its reference; see vernier compare --help");
  if (flags.no_flip && !flags.heatmap.empty())
    throw Error(ErrorKind::usage, "--heatmap shows FLIP, which --no-flip leaves out; drop one of the two");
  std::vector<Limit> limits;
  for (const auto& text : flags.fail) limits.emplace_back(text);
  require_separate_files({flags.picture, flags.reference}, {flags.heatmap});
  if (!flags.heatmap.empty()) check_writable_image(flags.heatmap);

  ComparisonOptions options = flags.options;
  options.flip = !flags.no_flip;
  const Comparison comparison = compare_files(flags.picture, flags.reference, options);
  std::vector<std::string> failed;
  for (const Limit& limit : limits)
    if (auto complaint = limit.complaint(comparison); !complaint.empty())
      failed.push_back(std::move(complaint));
  if (!flags.heatmap.empty()) write_image8(flags.heatmap, colormap(comparison.flip->map), {});
  if (flags.json)
    fmt::print("{}\n",
               to_json(flags, comparison, failed).dump(2, ' ', false, Json::error_handler_t::replace));
  else
    print_text(flags, comparison);
  for (const auto& text : failed) print_error("comparison failed: " + text);
  return failed.empty() ? ExitCode::done : ExitCode::comparison_failed;
}

std::string metric_names() {
  std::string names;
  for (const Metric& metric : metrics()) names += (names.empty() ? "" : ", ") + std::string(metric.name);
  return names;
}

}  // namespace

void register_compare(Program& program) {
  CLI::App* command =
      program.app.add_subcommand("compare", "Measure how a picture x differs from a reference r");
  auto flags = std::make_shared<CompareFlags>();
  command->add_option("X", flags->picture, "picture")->type_name("");
  command->add_option("R", flags->reference, "reference of the same size and kind")->type_name("");
  command->add_flag("--json", flags->json, "as JSON on standard output");
  command
      ->add_option("--heatmap", flags->heatmap,
                   "write the map of FLIP as .png or .jpg, dark for no difference")
      ->type_name("FILE");
  command
      ->add_option("--fail", flags->fail,
                   "exit with 1 when METRIC>NUMBER or METRIC<NUMBER; metrics: " + metric_names())
      ->type_name("LIMIT")
      ->allow_extra_args(false);
  command->add_flag("--no-flip", flags->no_flip, "leave out FLIP, which takes longest");
  command
      ->add_option(
          "--bias-level", flags->options.bias_level,
          "part of false findings allowed to the bias test, made when both files have an error layer")
      ->transform(real_number(1e-12, 0.999))
      ->type_name("PART")
      ->capture_default_str();
  command
      ->add_option("--bias-block", flags->options.bias_block,
                   "pixels a side of the squares that the bias test compares; 1 needs exact error layers")
      ->transform(whole_number(1, 65536))
      ->type_name("N")
      ->capture_default_str();
  command->callback([&program, flags] { program.run = [flags] { return run_compare(*flags); }; });
}

}  // namespace vernier::apps
