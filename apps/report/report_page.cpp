// SPDX-License-Identifier: Apache-2.0
#include "apps/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/report/html_page.h"
#include "apps/report/page_parts.h"
#include "core/base/quantities.h"
#include "core/display/colormap.h"
#include "core/film/error_estimate.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr int longest_picture = 1600;  // pixels: more is for the picture's own file
constexpr int longest_map = 800;

std::string percent(const Json& part) {
  return part.is_number() ? fmt::format("{:.3g} %", 100 * part.get<double>()) : "not known";
}

std::string seconds(const Json& value) { return format_seconds(value.get<double>()); }

std::string count(const Json& value) { return format_count(value.get<double>()); }

std::string stopped_by(const Json& stats) {
  const auto& reason = stats["picture"]["stopped_by"];
  if (reason == "error") return "error reached";
  if (reason == "interrupted") return "interrupted";
  const std::string text = reason == "samples" ? "all samples taken" : "time limit";
  const Json& error = stats["picture"]["asked"]["rel_rmse"];
  const bool missed = error.is_number() && !(stats["error"]["rel_rmse"] <= error);
  return !missed ? text : fmt::format("{}, before the error of {}", text, percent(error));
}

Image sample_counts(const Film& film) {
  Image map(film.width(), film.height(), 1);
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) *map.pixel(x, y) = float(film.samples(x, y));
  return map;
}

/// "3.5 to 3.9 %"
std::string interval(const Json& error) {
  if (!error.contains("low") || !error["low"].is_number()) return "not known";
  return fmt::format("{:.3g} to {}", 100 * error["low"].get<double>(), percent(error["high"]));
}

/// "3.7 % (3.5 to 3.9 %)"
std::string with_interval(const Json& error) {
  if (!error.contains("rel_rmse") || !error["rel_rmse"].is_number()) return "not known";
  return fmt::format("{} ({})", percent(error["rel_rmse"]), interval(error));
}

/// What the picture is worth, in a few sentences.
void add_verdict(HtmlPage& page, const Json& stats) {
  const Json& error = stats["error"];
  const bool is_denoised = stats.contains("denoised") && stats["denoised"].contains("rel_rmse");
  const Json& told = is_denoised ? stats["denoised"] : error;
  std::string text =
      told["rel_rmse"].is_number()
          ? fmt::format("{} is {} off, as far as sampling goes: relative RMSE, {} with 95 % confidence.",
                        is_denoised ? "The denoised picture" : "This picture", percent(told["rel_rmse"]),
                        interval(told))
          : "How far off this picture is, is not known: that takes 16 samples a pixel.";
  const Json& asked = stats["picture"]["asked"]["rel_rmse"];
  if (asked.is_number() && told["rel_rmse"].is_number())
    text += fmt::format(" {} was asked for{}.", percent(asked),
                        stats["picture"]["stopped_by"] == "error" ? " and reached" : " and not reached");
  const auto missing = [&](const char* name, const char* what) {
    const double share = stats["missing"][name]["share"];
    if (share >= 1e-3)
      text += fmt::format(" {} is not in it: up to {:.2g} % of all light.", what, 100 * share);
  };
  missing("bent", "Light of lamps behind glass that bends it");
  missing("depth", "Light on paths longer than --max-depth");
  if (const double doubtful = error["unreliable"].is_number() ? error["unreliable"].get<double>() : 0;
      doubtful > 0)
    text += fmt::format(" {:.2g} % of the pixels are not to be trusted.", 100 * doubtful);
  page.verdict(text);
}

void add_key_figures(HtmlPage& page, const Json& stats) {
  const Json& error = stats["error"];
  std::vector<std::array<std::string, 2>> figures{
      {"estimated error (relative RMSE)", percent(error["rel_rmse"])}, {"95 % interval", interval(error)}};
  if (stats.contains("denoised")) {
    const Json& denoised = stats["denoised"];
    figures[0][0] = "estimated error as rendered";
    figures.insert(figures.begin(),
                   {{"estimated error, denoised (relative RMSE)",
                     denoised.contains("rel_rmse") ? percent(denoised["rel_rmse"]) : "not known"},
                    {"95 % interval", interval(denoised)}});
  }
  figures.insert(figures.end(), {{"pixels not to be trusted", percent(error["unreliable"])},
                                 {"samples a pixel",
                                  fmt::format("{:.4g}", stats["picture"]["samples_per_pixel"].get<double>())},
                                 {"rendering", seconds(stats["seconds"]["render"])},
                                 {"rays a second", count(stats["rays"]["per_second"])},
                                 {"peak memory", format_bytes(stats["peak_memory_bytes"].get<double>())}});
  page.key_figures(figures);
}

/// What the picture's reader may ask of a pixel.
Image pixel_values(const Image& picture, const Image& relative_error) {
  Image values(picture.width, picture.height, 4);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      std::copy_n(picture.pixel(x, y), 3, values.pixel(x, y));
      values.pixel(x, y)[3] = *relative_error.pixel(x, y);
    }
  return values;
}

/// The picture and the map of its error; when there is a denoised one, that and its map too.
void add_pictures(HtmlPage& page, const Json& stats, const Film& film,
                  const std::optional<Denoised>& denoised, const DisplayOptions& display) {
  Viewer viewer;
  const auto add_picture = [&](const char* name, const Image& picture, const std::string& caption) {
    viewer.versions.push_back({name,
                               {to_display(shrink(picture, longest_picture), display),
                                fmt::format("{}View \"{}\".", caption, display.view), false}});
  };
  const Image rendered = film.image();
  const Image error = relative_error(rendered, error_layers(film).standard_error);
  const double scale = round_scale(shrink(error, longest_map));
  const auto add_map = [&](const char* name, const Image& map, const char* caption) {
    viewer.versions.push_back({name, map_figure(shrink(map, longest_picture), scale, caption, true)});
  };
  const Image* shown = &rendered;
  Image shown_error = error;
  if (denoised) {
    const Json& told = stats["denoised"];
    std::string noisy = "As rendered: estimated error " + with_interval(stats["error"]);
    if (denoised->error)
      noisy +=
          fmt::format(", {} when measured like the denoised picture's", percent(told["rel_rmse_before"]));
    add_picture("denoised", denoised->picture,
                fmt::format("Denoised by {}: estimated error {}. ", told["filter"].get<std::string>(),
                            with_interval(told)));
    add_picture("as rendered", rendered, noisy + ". ");
    shown = &denoised->picture;
    shown_error = denoised->pixel_error ? relative_error(denoised->picture, *denoised->pixel_error)
                                        : Image(rendered.width, rendered.height, 1);
    if (!denoised->pixel_error) std::fill(shown_error.values.begin(), shown_error.values.end(), NAN);
  } else {
    add_picture("picture", rendered, "");
  }
  add_map(denoised ? "error as rendered" : "error", error, "Estimated relative standard error");
  if (denoised && denoised->pixel_error)
    add_map("error after denoising", shown_error, "The same after denoising, blur included");
  viewer.values = pixel_values(shrink(*shown, longest_map), shrink(shown_error, longest_map));
  viewer.scale = shrink_factor(*shown, longest_map);
  page.viewer(viewer);
}

void add_doubt(HtmlPage& page, const Film& film) {
  page.section("What the error rests on");
  const Image counts = shrink(sample_counts(film), longest_map);
  std::vector<Figure> figures;
  const auto [fewest, most] = std::minmax_element(counts.values.begin(), counts.values.end());
  if (*fewest < *most) figures.push_back(map_figure(counts, round_scale(counts), "Samples", false));
  figures.push_back({colormap(shrink(error_layers(film).unreliable, longest_map)),
                     "Pixels not to be trusted: pale", false});
  page.figures(figures);
  page.paragraph(
      "The error is that of sampling only. A pixel is not to be trusted when what is known of it comes from "
      "too few samples: its error may be larger than estimated.");
}

void add_convergence(HtmlPage& page, const Json& stats) {
  Curve over_time{"estimated, with 95 % interval", {}, {}, false};
  Table table{{"seconds", "samples a pixel", "error", "low", "high", "not to be trusted"}, {}};
  Curve over_samples = over_time;
  for (const Json& row : stats["convergence"]) {
    const Json& error = row["error"];
    if (!error["rel_rmse"].is_number()) continue;
    const double y = error["rel_rmse"], spp = row["samples_per_pixel"], time = row["seconds"];
    over_time.points.push_back({time, y});
    over_samples.points.push_back({spp, y});
    over_time.band.push_back({error["low"], error["high"]});
    table.rows.push_back({fmt::format("{:.3f}", time), fmt::format("{:.4g}", spp), percent(y),
                          percent(error["low"]), percent(error["high"]), percent(error["unreliable"])});
  }
  page.section("How the error fell");
  if (table.rows.empty()) {
    page.paragraph("The error was not estimated: that takes 16 samples a pixel.");
    return;
  }
  over_samples.band = over_time.band;
  if (table.rows.size() > 1)
    page.charts({{"seconds of rendering", "relative RMSE", {over_time, square_root_guide(over_time)}},
                 {"samples a pixel", "relative RMSE", {over_samples, square_root_guide(over_samples)}}});
  page.table(table);
}

void add_time_and_rays(HtmlPage& page, const Json& stats) {
  const Json& time = stats["seconds"];
  const Json& rays = stats["rays"];
  page.section("Time and rays");
  const auto part = [](const char* name, const Json& value) {
    return BarPart{name, value.get<double>(), seconds(value)};
  };
  page.bar({part("load", time["load"]), part("build", time["build"]), part("render", time["render"]),
            part("output", time["output"])});
  const auto ray_part = [](const char* name, const Json& value) {
    return BarPart{name, value.get<double>(), count(value)};
  };
  page.bar({ray_part("camera rays", rays["camera"]), ray_part("bounce rays", rays["bounce"]),
            ray_part("shadow rays", rays["shadow"])});
  const Json& accelerator = stats["accelerator"];
  page.facts({{"rays", fmt::format("{}, {} a second", count(rays["total"]), count(rays["per_second"]))},
              {"samples", fmt::format("{}, {} a second", count(stats["picture"]["samples"]),
                                      count(rays["samples_per_second"]))},
              {"processor time", fmt::format("{} on {} threads", seconds(time["cpu"]),
                                             stats["machine"]["threads"].get<unsigned>())},
              {"accelerator", fmt::format("{}, built in {}, {}", accelerator["name"].get<std::string>(),
                                          seconds(accelerator["build_seconds"]),
                                          format_bytes(accelerator["bytes"].get<double>()))},
              {"peak memory", format_bytes(stats["peak_memory_bytes"].get<double>())}});
  if (stats.contains("resumed"))
    page.paragraph(fmt::format(
        "Rendering went on from {}, where {:.4g} samples a pixel and {} of rendering were done. They count "
        "here; load, build, output and processor time are those of the last part.",
        stats["resumed"]["file"].get<std::string>(), stats["resumed"]["samples_per_pixel"].get<double>(),
        seconds(stats["resumed"]["seconds"])));
}

void add_scene(HtmlPage& page, const Json& stats) {
  const Json& counts = stats["scene"]["counts"];
  const Json& picture = stats["picture"];
  page.section("Scene and picture");
  page.facts(
      {{"scene", stats["scene"]["file"]},
       {"fingerprint", stats["scene"]["hash"]},
       {"triangles", fmt::format("{} stored, {} with instances", count(counts["triangles"]),
                                 count(counts["instanced_triangles"]))},
       {"materials, textures",
        fmt::format("{}, {} ({})", count(counts["materials"]), count(counts["textures"]),
                    format_bytes(counts["texture_bytes"].get<double>()))},
       {"lights", fmt::format("{} punctual, {} emissive triangles{}", count(counts["punctual_lights"]),
                              count(counts["emissive_triangles"]),
                              counts["environment"].get<bool>() ? ", an environment" : "")},
       {"camera", picture["camera"]},
       {"size", fmt::format("{} x {}{}", picture["width"].get<int>(), picture["height"].get<int>(),
                            picture.contains("crop") ? ", part " + picture["crop"].get<std::string>() : "")},
       {"integrator", fmt::format("{}, at most {} path vertices", picture["integrator"].get<std::string>(),
                                  picture["max_depth"].get<int>())},
       {"seed", fmt::format("{}", picture["seed"].get<uint64_t>())},
       {"ended by", stopped_by(stats)}});
}

void add_notices(HtmlPage& page, const Json& stats) {
  page.section("Warnings and notes");
  std::vector<std::string> lines;
  for (const Json& notice : stats["notices"]) {
    const std::string place = notice["place"];
    lines.push_back(fmt::format("{}: {}{}{}", notice["severity"].get<std::string>(), place,
                                place.empty() ? "" : ": ", notice["text"].get<std::string>()));
  }
  if (lines.empty())
    page.paragraph("None.");
  else
    page.list(lines);
}

void add_reproduction(HtmlPage& page, const Json& stats) {
  page.section("To do it again");
  page.command(stats["command"].get<std::string>());
  if (stats.contains("resumed"))
    page.paragraph("Without --resume the same command renders the same picture from the beginning.");
  add_machine(page, stats["machine"], stats["built_with"]);
}

}  // namespace

std::string report_page(const Json& stats, const Film& film, const std::optional<Denoised>& denoised,
                        const DisplayOptions& display) {
  const std::string scene = std::filesystem::path(stats["scene"]["file"].get<std::string>()).filename();
  HtmlPage page("Render of " + scene,
                fmt::format("vernier {}, {} integrator, {} x {} pixels", stats["vernier"].get<std::string>(),
                            stats["picture"]["integrator"].get<std::string>(), film.width(), film.height()));
  add_verdict(page, stats);
  add_pictures(page, stats, film, denoised, display);
  add_key_figures(page, stats);
  add_doubt(page, film);
  add_convergence(page, stats);
  add_time_and_rays(page, stats);
  add_scene(page, stats);
  add_notices(page, stats);
  add_reproduction(page, stats);
  page.data("stats", stats);
  return page.text();
}

}  // namespace vernier::apps
