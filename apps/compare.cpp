#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "apps/commands.h"
#include "apps/messages.h"
#include "core/base/error.h"
#include "core/base/names.h"
#include "core/image/image_io.h"
#include "core/image/metrics.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

struct CompareFlags {
  std::string picture, reference;
  std::vector<std::string> fail;
  bool json = false;
};

/// What was measured of picture and reference.
struct Comparison {
  int width = 0, height = 0;
  ImageDifference difference;
  double peak = 1;  ///< that psnr counts from
};

/// A figure that `--fail` can limit.
struct Metric {
  std::string_view name;
  std::string_view description;
  double (*value)(const Comparison&);
};

constexpr Metric metrics[] = {
    {"mse", "mean (x-r)^2", [](const Comparison& c) { return c.difference.mse; }},
    {"rmse", "its square root", [](const Comparison& c) { return c.difference.rmse(); }},
    {"relmse", "mean (x-r)^2 / (r^2 + 0.01)", [](const Comparison& c) { return c.difference.rel_mse; }},
    {"mae", "mean |x-r|", [](const Comparison& c) { return c.difference.mae; }},
    {"psnr", "decibels", [](const Comparison& c) { return c.difference.psnr(c.peak); }},
    {"largest", "max |x-r|", [](const Comparison& c) { return c.difference.largest; }},
    {"not_finite", "values that are NaN or infinite, left out of the others",
     [](const Comparison& c) { return double(c.difference.not_finite); }},
};

/// METRIC>X or METRIC<X: when the comparison fails.
struct Limit {
  const Metric* metric;
  bool above;
  double bound;

  /// A metric that is not a number fails.
  bool broken_by(double value) const { return !(above ? value <= bound : value >= bound); }
};

Limit parse_limit(const std::string& text) {
  const size_t sign = text.find_first_of("<>");
  Limit limit{nullptr, sign != std::string::npos && text[sign] == '>', 0};
  const char* end = text.data() + text.size();
  const char* begin = sign == std::string::npos ? end : text.data() + sign + 1;
  const auto [stopped, status] = std::from_chars(begin, end, limit.bound);
  if (status != std::errc() || stopped != end)
    throw Error(ErrorKind::usage, {}, "--fail",
                fmt::format("expected METRIC>NUMBER or METRIC<NUMBER such as 'rmse>0.01', got '{}'", text));
  limit.metric = &find_by_name(metrics, "metric", text.substr(0, sign));
  return limit;
}

LayeredImage read(const std::string& path) {
  if (path.empty())
    throw Error(ErrorKind::usage,
                "which pictures? Give a picture and its reference; see vernier compare --help");
  return read_layers(path);
}

Comparison compare(const CompareFlags& flags) {
  const LayeredImage picture = read(flags.picture), reference = read(flags.reference);
  if (picture.linear != reference.linear)
    throw Error(ErrorKind::usage,
                fmt::format("{} holds {} and {} {}; compare pictures of one kind", flags.picture,
                            picture.linear ? "linear light" : "display values", flags.reference,
                            reference.linear ? "linear light" : "display values"));
  Comparison result;
  result.width = reference.image.width;
  result.height = reference.image.height;
  result.difference = difference(picture.rgb(), reference.rgb());
  result.peak = reference.linear ? result.difference.reference_largest : 1;
  return result;
}

Json to_json(const CompareFlags& flags, const Comparison& comparison,
             const std::vector<std::string>& failed) {
  const ImageDifference& d = comparison.difference;
  Json json{{"picture", flags.picture},
            {"reference", flags.reference},
            {"width", comparison.width},
            {"height", comparison.height},
            {"relmse_epsilon", 0.01},
            {"psnr_peak", comparison.peak},
            {"largest_at", {d.largest_x, d.largest_y}},
            {"mean", d.mean},
            {"reference_mean", d.reference_mean}};
  // JSON has no infinity; equal pictures have null decibels.
  for (const Metric& metric : metrics) json["metrics"][std::string(metric.name)] = metric.value(comparison);
  json["failed"] = failed;
  return json;
}

void print_text(const CompareFlags& flags, const Comparison& comparison) {
  const ImageDifference& d = comparison.difference;
  const auto line = [](std::string_view name, const std::string& text) {
    fmt::print("{:<12} {}\n", name, text);
  };
  fmt::print("{}\n", one_line(fmt::format("{} against {}, {}x{}", flags.picture, flags.reference,
                                          comparison.width, comparison.height)));
  for (const Metric& metric : metrics) {
    std::string note(metric.description);
    if (metric.name == "psnr") note += fmt::format(", from a peak of {:.6g}", comparison.peak);
    if (metric.name == "largest") note += fmt::format(", at ({}, {})", d.largest_x, d.largest_y);
    line(metric.name, fmt::format("{:<12.6g} {}", metric.value(comparison), note));
  }
  line("mean x", fmt::format("{:.6g} {:.6g} {:.6g}", d.mean[0], d.mean[1], d.mean[2]));
  line("mean r",
       fmt::format("{:.6g} {:.6g} {:.6g}", d.reference_mean[0], d.reference_mean[1], d.reference_mean[2]));
}

ExitCode run_compare(const CompareFlags& flags) {
  std::vector<Limit> limits;
  for (const auto& text : flags.fail) limits.push_back(parse_limit(text));
  const Comparison comparison = compare(flags);
  std::vector<std::string> failed;
  for (const Limit& limit : limits)
    if (const double value = limit.metric->value(comparison); limit.broken_by(value))
      failed.push_back(fmt::format("{} is {:.6g}, {} {:.6g}", limit.metric->name, value,
                                   limit.above ? "above" : "below", limit.bound));
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
  for (const Metric& metric : metrics) names += (names.empty() ? "" : ", ") + std::string(metric.name);
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
      ->add_option("--fail", flags->fail,
                   "exit with 1 when METRIC>NUMBER or METRIC<NUMBER; metrics: " + metric_names())
      ->type_name("LIMIT")
      ->allow_extra_args(false);
  command->callback([&program, flags] { program.run = [flags] { return run_compare(*flags); }; });
}

}  // namespace vernier::apps
