// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/bench/bench.h"
#include "apps/bench/bench_reference.h"
#include "apps/bench/query_meter.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/machine.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"
#include "core/compare/metrics.h"
#include "integrators/render/first_hit.h"
#include "integrators/render/render.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t most_printed_materials = 12;

struct ProfileFlags {
  RenderFlags render;  ///< scene, surroundings, size, how the picture is made
  int spp = 32;
  std::string json;
};

/// What is rendered again and again.
struct Subject {
  const Scene& scene;
  const Camera& camera;
  RenderSettings settings;
};

/// A picture and the processor time of all threads that it took.
struct Measured {
  RenderResult result;
  double seconds;

  double samples() const { return double(result.samples); }
};

Measured measure(const Subject& subject, uint64_t seed, const IntegratorOptions& options) {
  RenderSettings settings = subject.settings;
  settings.seed = seed;
  settings.integrator_options = options;
  const auto integrator = make_integrator(settings.integrator, options);
  const double before = cpu_seconds();
  RenderResult result = render(subject.scene, subject.camera, *integrator, settings, never_stop);
  return {std::move(result), cpu_seconds() - before};
}

/// Variance of one sample of each pixel, relative to r^2 + 0.01, mean of the channels: by the halves'
/// difference, so that what stratification spares counts.
std::vector<double> relative_variances(const Film& film, const Image& r) {
  std::vector<double> variances;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const Vec3d apart = (film.half_mean(x, y, 0) - film.half_mean(x, y, 1)) / 2.0;
      double sum = 0;
      for (int c = 0; c < 3; ++c) sum += relative_squared(apart[c] * apart[c], double(r.pixel(x, y)[c])) / 3;
      variances.push_back(sum * film.samples(x, y));
    }
  return variances;
}

struct Mean {
  double all, trimmed;  ///< the latter without the largest thousandth
};

Mean mean_of(std::vector<double> values) {
  const auto sum = [&] { return std::accumulate(values.begin(), values.end(), 0.0); };
  const double all = sum() / double(values.size());
  std::sort(values.begin(), values.end());
  values.resize(values.size() - std::min(values.size() - 1, std::max<size_t>(1, values.size() / 1000)));
  return {all, sum() / double(values.size())};
}

/// Where the processor's time goes: rays by kind, and the rest.
Json time_profile(const QueryMeter& meter, const Measured& metered, double seconds_a_sample) {
  constexpr std::array<const char*, QueryMeter::kinds> names{"closest", "occlusion", "all_hits"};
  Json rows = Json::array();
  double rest = seconds_a_sample;
  for (size_t kind = 0; kind < names.size(); ++kind) {
    const QueryTotals totals = meter.totals(QueryMeter::Kind(kind));
    if (totals.count == 0) continue;
    const double a_sample = double(totals.count) / metered.samples();
    rest -= a_sample * totals.seconds_each;
    rows.push_back({{"kind", names[kind]},
                    {"a_sample", a_sample},
                    {"met", double(totals.met) / double(totals.count)},
                    {"nanoseconds_each", 1e9 * totals.seconds_each},
                    {"share", a_sample * totals.seconds_each / seconds_a_sample}});
    if (kind == QueryMeter::closest_hit)
      rows.back().update({{"nodes", totals.nodes_each}, {"blocks", totals.blocks_each}});
  }
  rows.push_back({{"kind", "rest"}, {"share", rest / seconds_a_sample}});
  return rows;
}

/// Variance and time of ever longer paths, up to the depth that was asked for.
Json depth_profile(const Subject& subject, const Image& r, const IntegratorOptions& options) {
  Json rows = Json::array();
  for (int depth = 1;; depth = std::min(depth < 4 ? depth + 1 : 2 * depth, options.max_depth)) {
    IntegratorOptions shorter = options;
    shorter.max_depth = depth;
    const Measured picture = measure(subject, 1, shorter);
    const Mean variance = mean_of(relative_variances(picture.result.film, r));
    rows.push_back({{"max_depth", depth},
                    {"nanoseconds_per_sample", 1e9 * picture.seconds / picture.samples()},
                    {"relative_variance", variance.all},
                    {"relative_variance_trim", variance.trimmed}});
    if (depth == options.max_depth) return rows;
  }
}

/// Variance by the material that the pixel's centre shows, most of it first.
Json material_profile(const Subject& subject, const Film& film, const std::vector<double>& variances) {
  struct Part {
    double variance = 0;
    size_t pixels = 0;
  };
  const FirstHits first(subject.scene, subject.camera, subject.settings, film);
  const SceneNames& names = subject.scene.names();
  std::map<std::string, Part> parts;
  for (int y = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x) {
      const auto hit = first.at_center(x, y);
      Part& part = parts[hit ? names.texts()[names.of(hit->instance).material] : "(nothing)"];
      part.variance += variances[size_t(y) * size_t(film.width()) + size_t(x)];
      ++part.pixels;
    }
  const double all = std::accumulate(variances.begin(), variances.end(), 0.0);
  std::vector<std::pair<std::string, Part>> sorted(parts.begin(), parts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second.variance > b.second.variance; });
  Json rows = Json::array();
  for (const auto& [name, part] : sorted)
    rows.push_back({{"material", name},
                    {"pixels", double(part.pixels) / double(variances.size())},
                    {"relative_variance", part.variance / double(part.pixels)},
                    {"share", all > 0 ? part.variance / all : 0}});
  return rows;
}

std::string percent(const Json& part) { return fmt::format("{:.1f} %", 100 * part.get<double>()); }
std::string figure(const Json& row, const char* key) {
  return row.contains(key) ? fmt::format("{:.3g}", row[key].get<double>()) : "";
}

void print_report(const Json& report) {
  std::vector<std::vector<std::string>> rows{
      {"time", "a sample", "met something", "ns each", "part of the time", "nodes", "blocks"}};
  for (const Json& row : report["time"])
    rows.push_back({row["kind"], figure(row, "a_sample"), row.contains("met") ? percent(row["met"]) : "",
                    figure(row, "nanoseconds_each"), percent(row["share"]), figure(row, "nodes"),
                    figure(row, "blocks")});
  fmt::print("{:.4g} ns a sample\n{}\n", report["nanoseconds_per_sample"].get<double>(), text_table(rows));
  rows = {{"--max-depth", "ns a sample", "variance of a sample", "without the worst 0.1 %"}};
  for (const Json& row : report["depth"])
    rows.push_back({std::to_string(row["max_depth"].get<int>()), figure(row, "nanoseconds_per_sample"),
                    figure(row, "relative_variance"), figure(row, "relative_variance_trim")});
  fmt::print("{}\n", text_table(rows));
  rows = {{"first material", "pixels", "variance of a sample", "part of the variance"}};
  const Json& materials = report["materials"];
  for (size_t i = 0; i < std::min(materials.size(), most_printed_materials); ++i)
    rows.push_back({materials[i]["material"], percent(materials[i]["pixels"]),
                    figure(materials[i], "relative_variance"), percent(materials[i]["share"])});
  fmt::print("{}", text_table(rows));
  if (materials.size() > most_printed_materials)
    fmt::print("and {} more, which --json lists\n", materials.size() - most_printed_materials);
}

/// Measures the scene, which answers rays by another accelerator afterwards.
Json profile(Scene& scene, const Camera& camera, const RenderSettings& settings) {
  const Subject subject{scene, camera, settings};
  const IntegratorOptions& options = settings.integrator_options;
  const Measured other = measure(subject, 2, options);
  const Image r = other.result.film.image();
  const Measured picture = measure(subject, 1, options);
  const std::vector<double> variances = relative_variances(picture.result.film, r);
  Json depth = depth_profile(subject, r, options);

  const Geometry geometry = scene.accelerated_geometry();
  const auto built = [&](std::string_view name) {
    return find_by_name(accelerators(), "accelerator", name).build(geometry);
  };
  auto meter = std::make_unique<QueryMeter>(built(scene.accelerator_name()), built("bvh"));
  const QueryMeter& counts = *meter;
  scene.replace_accelerator(std::move(meter));
  const Measured metered = measure(subject, 1, options);
  const double seconds_a_sample = picture.seconds / picture.samples();
  return {{"nanoseconds_per_sample", 1e9 * seconds_a_sample},
          {"time", time_profile(counts, metered, seconds_a_sample)},
          {"depth", std::move(depth)},
          {"materials", material_profile(subject, picture.result.film, variances)}};
}

ExitCode run_bench_profile(const ProfileFlags& flags, const Program& program) {
  require_scene(flags.render.scene, "bench profile");
  if (!flags.json.empty()) check_writable(flags.json);
  if (!flags.render.accelerator.empty())
    find_by_name(accelerators(), "accelerator", flags.render.accelerator);
  auto [read, view, settings] = read_bench_scene(flags.render, nullptr);
  Scene& scene = *read;
  settings.adaptive = false;
  settings.limits.spp = flags.spp;
  settings.integrator_options = flags.render.integrator_options;
  const Camera camera(view, settings.width, settings.height);

  Json report = bench_header(program);
  report["scene"] = flags.render.scene;
  report["width"] = settings.width;
  report["height"] = settings.height;
  report["samples_per_pixel"] = flags.spp;
  report["accelerator"] = scene.accelerator_name();
  report.update(profile(scene, camera, settings));
  print_report(report);
  if (!flags.json.empty())
    write_file(flags.json, report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  return ExitCode::done;
}

}  // namespace

void register_bench_profile(CLI::App& bench, Program& program) {
  CLI::App* command =
      bench.add_subcommand("profile", "Where a scene's time and variance go: by rays, depth and material");
  auto flags = std::make_shared<ProfileFlags>();
  add_scene_flags(*command, flags->render.scene, flags->render.import);
  command->add_option("--spp", flags->spp, "samples a pixel of each picture, evenly")
      ->transform(whole_number(2, 1 << 20))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--accelerator", flags->render.accelerator, "that answers the rays (embree)")
      ->type_name("NAME");
  add_measured_picture_flags(*command, flags->render);
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->callback(
      [&program, flags] { program.run = [&program, flags] { return run_bench_profile(*flags, program); }; });
}

}  // namespace vernier::apps
