// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/render_report.h"
#include "core/base/build.h"
#include "vernier/version.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/vernier/machine.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/missing_text.h"
#include "core/base/quantities.h"
#include "integrators/render/pixel_filter.h"
#include "integrators/render/texture_filter.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

uint64_t total(const RayCounts& rays) { return rays.camera + rays.bounce + rays.shadow; }

double rate(uint64_t count, double seconds) { return seconds > 0 ? double(count) / seconds : 0; }

/// A figure that JSON can hold: null while it is not known.
Json known(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Of both halves; 0 where all light comes by camera samples.
uint64_t light_paths(const RenderResult& result) {
  const auto& halves = result.film.light_paths();
  return std::accumulate(halves.begin(), halves.end(), uint64_t{0});
}

/// Where the picture was taken from, as the flags of the command line take it.
Json view_json(const CameraDescription& camera) {
  const auto numbers = [](const Vec3f& v) { return Json{v.x, v.y, v.z}; };
  const Vec3f &from = camera.to_world.origin, ahead = -normalize(camera.to_world.z);
  // Far from the origin, a point that is nearer would be told too coarsely for the direction to it.
  Json view = {{"from", numbers(from)},
               {"at", numbers(from + ahead * std::max(1.0f, length(from)))},
               {"up", numbers(normalize(camera.to_world.y))}};
  if (camera.kind == CameraDescription::Kind::perspective) view["fov"] = camera.yfov * 180 / pi;
  if (camera.kind == CameraDescription::Kind::orthographic) view["ortho"] = 2 * camera.ymag;
  return view;
}

Json picture_json(const RenderReport& report, const RenderFlags& flags, const RenderResult& result) {
  Json picture = {{"width", report.settings.width},
                  {"height", report.settings.height},
                  {"integrator", flags.integrator},
                  {"camera", report.camera},
                  {"view", view_json(report.settings.camera)},
                  {"surroundings", report.surroundings.name},
                  {"filter", filter_text(report.settings.filter)},
                  {"texture_filter", texture_filter_text(report.settings.texture_filter)},
                  {"texture_mip_bytes", report.texture_mip_bytes},
                  {"background", background_text(report.settings.background)},
                  {"seed", flags.seed},
                  {"max_depth", flags.integrator_options.max_depth},
                  {"light_paths", light_paths(result)},
                  {"samples", result.samples},
                  {"samples_per_pixel", samples_per_pixel(result)},
                  {"asked", asked_json(report.settings)},
                  {"stopped_by", name_of(result.reason)},
                  {"files", report.files}};
  if (report.lens) picture["lens"] = to_json(*report.lens);
  if (report.settings.crop.width > 0) picture["crop"] = crop_text(report.settings.crop);
  return picture;
}

Json error_json(const ErrorEstimate& error) {
  return {{"rel_rmse", known(error.rel_rmse)},
          {"low", known(error.low)},
          {"high", known(error.high)},
          {"confidence", 0.95},
          {"unreliable", error.unreliable}};
}

Json convergence_json(const RenderResult& result) {
  Json rows = Json::array();
  for (const auto& [seconds, spp, error] : result.convergence)
    rows.push_back({{"seconds", seconds}, {"samples_per_pixel", spp}, {"error", error_json(error)}});
  return rows;
}

Json rays_json(const RenderResult& result) {
  return {{"camera", result.rays.camera},
          {"bounce", result.rays.bounce},
          {"shadow", result.rays.shadow},
          {"total", total(result.rays)},
          {"per_second", rate(total(result.rays), result.seconds)},
          {"samples_per_second", rate(result.samples, result.seconds)}};
}

Json bad_samples_json(const RenderResult& result) {
  Json examples = Json::array();
  for (const BadSample& sample : result.bad_sample_examples)
    examples.push_back({{"x", sample.x}, {"y", sample.y}, {"half", sample.half}, {"index", sample.index}});
  return {{"count", result.bad_samples}, {"examples", examples}};
}

std::string written(const RenderReport& report) {
  if (!report.files.empty()) return fmt::format("{}", fmt::join(report.files, ", "));
  return report.kept.empty() ? "nothing" : report.kept;
}

/// What was asked for and not reached, if anything.
std::string shortfall(const RenderReport& report, const RenderResult& result) {
  if (result.reason == StopReason::interrupted) return "; interrupted";
  const double asked = report.settings.limits.error;
  if (asked == 0) return "";
  if (exceeds(result.missing, asked))
    return fmt::format("; the error of {:.3g} % is not reached, for more than that is missing", 100 * asked);
  if (result.error.rel_rmse <= asked) return "";
  return fmt::format("; {} before the error of {:.3g} %",
                     result.reason == StopReason::time ? "time was up" : "all samples were taken",
                     100 * asked);
}

}  // namespace

std::string_view name_of(StopReason reason) {
  switch (reason) {
    case StopReason::samples:
      return "samples";
    case StopReason::time:
      return "time";
    case StopReason::error:
      return "error";
    case StopReason::interrupted:
      return "interrupted";
  }
  return "";
}

Json asked_json(const RenderSettings& options) {
  return {{"samples_per_pixel", options.limits.spp > 0 ? Json(options.limits.spp) : Json(nullptr)},
          {"seconds", known(options.limits.seconds)},
          {"rel_rmse", options.limits.error > 0 ? Json(options.limits.error) : Json(nullptr)}};
}

std::string error_text(const ErrorEstimate& error) {
  if (!std::isfinite(error.rel_rmse)) return "";
  std::string text = fmt::format(", error {:.3g} % ({:.3g} to {:.3g} %)", 100 * error.rel_rmse,
                                 100 * error.low, 100 * error.high);
  if (error.unreliable >= 0.001)
    text += fmt::format(", {:.1f} % of pixels not to be trusted", 100 * error.unreliable);
  return text;
}

Metadata image_metadata(const RenderReport& report, const RenderFlags& flags, const RenderResult& result) {
  Metadata metadata = {
      {"vernier:command", report.picture_command},
      {"vernier:scene", report.scene_file},
      {"vernier:sceneHash", report.scene_hash},
      {"vernier:camera", report.camera},
      {"vernier:surroundings", report.surroundings.name},
      {"vernier:filter", filter_text(report.settings.filter)},
      {"vernier:background", background_text(report.settings.background)},
      {"vernier:integrator", flags.integrator},
      {"vernier:accelerator", report.accelerator},
      {"vernier:platform", platform()},
      {"vernier:seed", fmt::format("{}", flags.seed)},
      {"vernier:stoppedBy", std::string(name_of(result.reason))},
      {"vernier:size", fmt::format("{}x{}", report.settings.width, report.settings.height)},
  };
  metadata.merge(result_metadata(result));
  if (const TextureFilter& filter = report.settings.texture_filter; filter.is_on())
    metadata["vernier:textureFilter"] = texture_filter_text(filter) + " (approximated)";
  if (report.lens) metadata["vernier:lens"] = lens_text(*report.lens);
  if (report.settings.crop.width > 0) metadata["vernier:crop"] = crop_text(report.settings.crop);
  return metadata;
}

Json stats_json(const RenderReport& report, const RenderFlags& flags, const RenderResult& result,
                const NoticeLog& log) {
  return {{"vernier", version()},
          {"command", report.command_line},
          {"scene",
           {{"file", report.scene_file}, {"hash", report.scene_hash}, {"counts", to_json(report.counts)}}},
          {"picture", picture_json(report, flags, result)},
          {"seconds",
           {{"load", report.load_seconds},
            {"build", report.build_seconds},
            {"render", result.seconds},
            {"output", report.output_seconds},
            {"cpu", cpu_seconds()}}},
          {"rays", rays_json(result)},
          {"error", error_json(result.error)},
          {"missing", missing_json(result.missing)},
          {"convergence", convergence_json(result)},
          {"accelerator",
           {{"name", report.accelerator},
            {"build_seconds", report.accelerator_stats.build_seconds},
            {"bytes", report.accelerator_stats.bytes}}},
          {"peak_memory_bytes", peak_memory_bytes()},
          {"bad_samples", bad_samples_json(result)},
          {"notices", to_json(log.notices())},
          {"machine", {{"cpu", cpu_name()}, {"threads", report.threads}}},
          {"built_with", build_versions()}};
}

std::string scene_lines(const RenderReport& report) {
  const SceneCounts& counts = report.counts;
  return fmt::format(
             "scene: {} triangles in {} meshes, {} in {} instances; {} materials, {} textures ({}), {} "
             "punctual lights, {} emissive triangles\n",
             counts.triangles, counts.meshes, counts.instanced_triangles, counts.instances, counts.materials,
             counts.textures, texture_bytes_text(counts), counts.punctual_lights, counts.emissive_triangles) +
         fmt::format("accelerator: {}, {}, built in {}\n", report.accelerator,
                     format_bytes(double(report.accelerator_stats.bytes)),
                     format_seconds(report.accelerator_stats.build_seconds)) +
         fmt::format(
             "rendering {}x{}, filter {}, texture filter {}{}, on {} threads, {} of memory in use at most so "
             "far\n",
             report.settings.width, report.settings.height, filter_text(report.settings.filter),
             texture_filter_text(report.settings.texture_filter),
             report.lens ? ", " + lens_text(*report.lens) : "", report.threads,
             format_bytes(double(peak_memory_bytes())));
}

std::string summary_line(const RenderReport& report, const RenderResult& result) {
  return fmt::format("wrote {}: {}x{}, {:.4g} spp{}, load {}, build {}, render {}, {} rays/s{}",
                     written(report), result.film.width(), result.film.height(), samples_per_pixel(result),
                     error_text(result.error) + missing_text(result.missing) +
                         (report.settings.texture_filter.is_on() ? " + textures approximated" : ""),
                     format_seconds(report.load_seconds), format_seconds(report.build_seconds),
                     format_seconds(result.seconds), format_count(rate(total(result.rays), result.seconds)),
                     shortfall(report, result));
}

}  // namespace vernier::apps
