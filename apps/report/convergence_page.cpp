// SPDX-License-Identifier: Apache-2.0
#include "apps/report/convergence_page.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/report/page_parts.h"
#include "core/base/quantities.h"
#include "core/display/display.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr int longest_picture = 800;
constexpr int crop_side = 48;  // pixels, shown enlarged

std::string percent(const Json& value) {
  return value.is_number() ? fmt::format("{:.3g} %", 100 * value.get<double>()) : "-";
}

std::string seconds(const Json& value) {
  return value.is_number() ? format_seconds(value.get<double>()) : "never";
}

std::string figure(const Json& value) {
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "-";
}

/// Two decimals; what rounds to nought has no sign.
std::string slope(const Json& value) {
  const double rounded = std::round(100 * value.get<double>()) / 100;
  return fmt::format("{:.2f}", rounded == 0 ? 0 : rounded);
}

std::string file_name(const Json& scene) {
  return std::filesystem::path(scene["file"].get<std::string>()).filename().string();
}

std::string name(const Json& candidate) {
  return candidate["integrator"].get<std::string>() + ", " + candidate["accelerator"].get<std::string>();
}

std::vector<std::string> summary_row(const Json& scene, const Json& candidate) {
  const Json& last = candidate["points"].back();
  const Json& fit = candidate["fit"];
  std::vector<std::string> row{file_name(scene),
                               name(candidate),
                               percent(last["rel_rmse"]["median"]),
                               fit.is_null() ? "-" : slope(fit["slope"]),
                               fit.is_null() ? "-" : slope(fit["last_slope"]),
                               fit.is_null() ? "-" : percent(fit["floor"]),
                               percent(candidate["systematic"]),
                               figure(last["efficiency"])};
  if (!fit.is_null())
    for (const Json& reach : fit["reach"])
      row.push_back((reach["measured"].get<bool>() || reach["seconds"].is_null() ? "" : "~") +
                    seconds(reach["seconds"]));
  return row;
}

void add_summary(HtmlPage& page, const Json& report) {
  page.section("In short");
  Table table{{"scene", "integrator, accelerator", "error after " + seconds(report["times"].back()), "slope",
               "last slope", "floor", "systematic", "efficiency"},
              {}};
  if (report["times"].size() > 1)
    for (const char* error : {"10", "5", "2", "1"})  // with spaces that do not break
      table.columns.push_back(fmt::format("to\u00a0{}\u00a0%", error));
  for (const Json& scene : report["scenes"])
    for (const Json& candidate : scene["candidates"]) table.rows.push_back(summary_row(scene, candidate));
  page.table(table);
  page.paragraph(
      "Error is the relative RMSE against the reference, sqrt(mean((x - r)^2 / (r^2 + 0.01))), with the "
      "variance of the reference taken off; the median over seeds.");
  page.paragraph(
      "Slope is that of error over time on logarithmic axes. Sampling without bias gives -1/2; a slope "
      "nearer to nought at the end means that the curve flattens.");
  page.paragraph(
      "Floor is the error at which the curve would flatten, fitted as error^2 = floor^2 + variance / time; "
      "systematic is what all seeds have in common after the longest time. Both are bias, or what the "
      "reference lacks: below its own error they say nothing.");
  page.paragraph(
      "Efficiency is 1 / (relative MSE x seconds of rendering) at the longest time. Times to reach an error "
      "are read off between measured points, those with ~ from the fit.");
}

Chart chart_of(const Json& scene, const char* abscissa, const std::string& x_label) {
  Chart chart{x_label, "relative RMSE", {}};
  for (const Json& candidate : scene["candidates"]) {
    Curve curve{name(candidate), {}, {}, false};
    for (const Json& point : candidate["points"]) {
      const Json& error = point["rel_rmse"];
      curve.points.push_back({point[abscissa], error["median"]});
      curve.band.push_back({error["low"], error["high"]});
    }
    chart.curves.push_back(std::move(curve));
  }
  const Curve guide = square_root_guide(chart.curves.front());
  chart.curves.push_back(guide);
  return chart;
}

void add_points(HtmlPage& page, const Json& scene) {
  Table table{{"integrator, accelerator", "asked", "rendered", "samples a pixel", "error", "lowest",
               "highest", "estimated", "efficiency"},
              {}};
  for (const Json& candidate : scene["candidates"])
    for (const Json& point : candidate["points"])
      table.rows.push_back({name(candidate), seconds(point["asked_seconds"]), seconds(point["seconds"]),
                            fmt::format("{:.4g}", point["samples_per_pixel"].get<double>()),
                            percent(point["rel_rmse"]["median"]), percent(point["rel_rmse"]["low"]),
                            percent(point["rel_rmse"]["high"]), percent(point["estimated"]),
                            figure(point["efficiency"])});
  page.table(table);
}

void add_preparation(HtmlPage& page, const Json& scene) {
  page.heading("Before rendering");
  Table table{{"accelerator", "load", "build"}, {}};
  std::string last;
  for (const Json& candidate : scene["candidates"]) {
    const std::string accelerator = candidate["accelerator"];
    if (accelerator == last) continue;
    last = accelerator;
    table.rows.push_back({accelerator, seconds(scene["load_seconds"]), seconds(candidate["build_seconds"])});
  }
  page.table(table);
}

/// Upper left corner of the square of `side` pixels with the most error.
std::array<int, 2> worst_part(const Image& error, int width, int height) {
  std::array<int, 2> worst{0, 0};
  double most = -1;
  for (int y = 0; y + height <= error.height; y += std::max(1, height / 2))
    for (int x = 0; x + width <= error.width; x += std::max(1, width / 2)) {
      double sum = 0;
      for (const float value : cut(error, x, y, width, height).values) sum += value;
      if (sum > most) {
        most = sum;
        worst = {x, y};
      }
    }
  return worst;
}

void add_pictures(HtmlPage& page, const SceneConvergence& scene) {
  const DisplayOptions display{display_views({}).front(), {}, 0};
  const Image& error = scene.pictures.front().error;
  const int width = std::min(crop_side, error.width), height = std::min(crop_side, error.height);
  const auto [x, y] = worst_part(error, width, height);
  const double scale = round_scale(error);
  std::vector<Figure> crops, maps;
  const auto add_crop = [&, x = x, y = y](const Image& picture, const std::string& caption) {
    crops.push_back({to_display(cut(picture, x, y, width, height), display), caption, true});
  };
  maps.push_back({to_display(shrink(scene.reference, longest_picture), display), "Reference", false});
  add_crop(scene.reference, "Reference");
  for (const ConvergencePictures& pictures : scene.pictures) {
    maps.push_back(map_figure(shrink(pictures.error, longest_picture), scale, pictures.name, true));
    add_crop(pictures.picture, pictures.name);
  }
  page.heading("Error of one run of the longest time");
  page.figures(maps);
  page.heading(fmt::format("Where it is largest: {} x {} pixels at {}, {}", width, height, x, y));
  page.figures(crops);
}

void add_scene(HtmlPage& page, const SceneConvergence& scene) {
  const Json& json = scene.json;
  page.section(file_name(json));
  const Json& reference = json["reference"];
  const std::string source =
      reference.contains("file")
          ? reference["file"].get<std::string>()
          : fmt::format("path, {} samples a pixel, {}", reference["samples_per_pixel"].get<int>(),
                        seconds(reference["seconds"]));
  page.paragraph(fmt::format("{} x {} pixels, camera {}. Reference: {}; its own estimated error is {}.",
                             json["width"].get<int>(), json["height"].get<int>(),
                             json["camera"].get<std::string>(), source,
                             reference["rel_rmse"].is_null() ? "not known" : percent(reference["rel_rmse"])));
  page.charts({chart_of(json, "seconds", "seconds of rendering"),
               chart_of(json, "samples_per_pixel", "samples a pixel")});
  add_points(page, json);
  add_preparation(page, json);
  add_pictures(page, scene);
}

}  // namespace

std::string convergence_page(const Json& report, const std::vector<SceneConvergence>& scenes) {
  HtmlPage page("Error against time",
                fmt::format("vernier {}, {}, {} seeds", report["vernier"].get<std::string>(),
                            report["date"].get<std::string>(), report["seeds"].get<int>()));
  add_summary(page, report);
  for (const SceneConvergence& scene : scenes) add_scene(page, scene);
  page.section("To do it again");
  page.command(report["command"].get<std::string>());
  add_machine(page, report["machine"], report["built_with"]);
  page.data("convergence", report);
  return page.text();
}

}  // namespace vernier::apps
