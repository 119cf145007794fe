// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/bench/bench_reference.h"
#include "apps/bench/convergence_fit.h"
#include "apps/vernier/choose_camera.h"
#include "apps/vernier/scene_summary.h"
#include "core/base/names.h"
#include "core/compare/metrics.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr double errors_to_reach[] = {0.10, 0.05, 0.02, 0.01};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Run {
  uint64_t seed = 0;
  double seconds = 0, samples_per_pixel = 0;
  uint64_t rays = 0;
  double rel_mse = 0;  ///< against the reference, the reference's own variance taken off
  ErrorEstimate estimate;
};

/// The mean over pixels and channels of (x - r)^2 / (r^2 + 0.01) falls apart into the part that differs from
/// seed to seed and the part that does not; sums over seeds tell the two.
class SeedSums {
 public:
  void add(const Image& picture) {
    sum_.resize(picture.values.size());
    squares_.resize(picture.values.size());
    for (size_t i = 0; i < sum_.size(); ++i) {
      sum_[i] += picture.values[i];
      squares_[i] += square(double(picture.values[i]));
    }
    ++count_;
  }

  /// Estimate without bias of the squared relative error that all seeds have in common; may come out
  /// negative.
  double common(const Image& reference) const {
    double total = 0;
    for (size_t i = 0; i < sum_.size(); ++i) {
      const double mean = sum_[i] / count_, r = reference.values[i];
      const double variance = (squares_[i] / count_ - mean * mean) / (count_ - 1);  // of the mean
      total += relative_squared(square(mean - r) - variance, r);
    }
    return total / double(sum_.size());
  }

 private:
  std::vector<double> sum_, squares_;
  double count_ = 0;
};

struct Candidate {
  std::string integrator_name, accelerator_name;
  std::unique_ptr<Integrator> integrator;
  const Scene* scene = nullptr;
  double build_seconds = 0;
  std::vector<std::vector<Run>> runs;  ///< by time, then seed
  SeedSums longest;
  ConvergencePictures pictures;

  std::string name() const { return fmt::format("{}, {}", integrator_name, accelerator_name); }
};

Run measure(Candidate& candidate, const Camera& camera, const RenderSettings& options,
            const Reference& reference, bool longest) {
  const RenderResult result = render(*candidate.scene, camera, *candidate.integrator, options, never_stop);
  const Image picture = result.film.image();
  if (longest) {
    candidate.longest.add(picture);
    if (candidate.pictures.picture.empty())
      candidate.pictures = {candidate.name(), picture, relative_error_map(picture, reference.picture)};
  }
  Run run;
  run.seed = options.seed;
  run.seconds = result.seconds;
  run.samples_per_pixel = double(result.samples) / (double(picture.width) * picture.height);
  run.rays = result.rays.camera + result.rays.bounce + result.rays.shadow;
  const Image shown = result.film.coverage();
  run.rel_mse = std::max(0.0, difference(picture, reference.picture, &shown).rel_mse - reference.rel_mse);
  run.estimate = result.error;
  return run;
}

template <typename Value>
std::vector<double> values_of(const std::vector<Run>& runs, const Value& value) {
  std::vector<double> values(runs.size());
  std::transform(runs.begin(), runs.end(), values.begin(), value);
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

Json known(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json runs_json(const std::vector<Run>& runs) {
  Json rows = Json::array();
  for (const Run& run : runs)
    rows.push_back({{"seed", run.seed},
                    {"seconds", run.seconds},
                    {"samples_per_pixel", run.samples_per_pixel},
                    {"rays", run.rays},
                    {"rel_rmse", std::sqrt(run.rel_mse)},
                    {"estimated",
                     {{"rel_rmse", known(run.estimate.rel_rmse)},
                      {"low", known(run.estimate.low)},
                      {"high", known(run.estimate.high)},
                      {"unreliable", run.estimate.unreliable}}}});
  return rows;
}

Json point_json(double asked, const std::vector<Run>& runs) {
  const auto errors = values_of(runs, [](const Run& run) { return std::sqrt(run.rel_mse); });
  const auto seconds = values_of(runs, [](const Run& run) { return run.seconds; });
  const auto [low, high] = std::minmax_element(errors.begin(), errors.end());
  const double rel_mse = mean(values_of(runs, [](const Run& run) { return run.rel_mse; }));
  return {
      {"asked_seconds", asked},
      {"seconds", median(seconds)},
      {"samples_per_pixel", median(values_of(runs, [](const Run& run) { return run.samples_per_pixel; }))},
      {"rel_rmse", {{"median", median(errors)}, {"low", *low}, {"high", *high}}},
      {"estimated", known(median(values_of(runs, [](const Run& run) { return run.estimate.rel_rmse; })))},
      {"rel_mse", rel_mse},
      {"efficiency", known(1 / (rel_mse * mean(seconds)))},
      {"runs", runs_json(runs)}};
}

Json fit_json(const std::vector<ErrorAt>& points) {
  const auto fit = fit_convergence(points);
  if (!fit) return nullptr;
  Json reach = Json::array();
  for (const double error : errors_to_reach) {
    const auto time = time_to_reach(error, points, *fit);
    reach.push_back({{"rel_rmse", error},
                     {"seconds", time ? Json(time->seconds) : Json(nullptr)},
                     {"measured", time && time->measured}});
  }
  return {{"slope", fit->slope}, {"last_slope", fit->last_slope}, {"floor", fit->floor}, {"reach", reach}};
}

Json candidate_json(const Candidate& candidate, const ConvergencePlan& plan, const Reference& reference) {
  Json points = Json::array();
  std::vector<ErrorAt> medians;
  double most_samples = 0;
  for (size_t t = 0; t < plan.times.size(); ++t) {
    points.push_back(point_json(plan.times[t], candidate.runs[t]));
    const Json& point = points.back();
    // An error as small as the reference's comes out as nothing, which has no logarithm. A time too short for
    // the first pass gives the picture of the one before, and says nothing of how the error falls.
    const ErrorAt middle{point["seconds"], point["rel_rmse"]["median"]};
    const double samples = point["samples_per_pixel"];
    if (!(middle.error > 0 && samples > most_samples)) continue;
    most_samples = samples;
    medians.push_back(middle);
  }
  Json systematic = nullptr;
  if (plan.seeds > 1) {
    const double common = candidate.longest.common(reference.picture) - reference.rel_mse;
    systematic = common > 0 ? std::sqrt(common) : 0;
  }
  return {{"integrator", candidate.integrator_name},
          {"accelerator", candidate.accelerator_name},
          {"build_seconds", candidate.build_seconds},
          {"points", points},
          {"fit", fit_json(medians)},
          {"systematic", systematic}};
}

/// One scene an accelerator, and one candidate an integrator on it.
std::vector<Candidate> make_candidates(const ConvergencePlan& plan, const SceneDescription& description,
                                       std::vector<std::unique_ptr<Scene>>& scenes) {
  std::vector<Candidate> candidates;
  for (const auto& accelerator : plan.accelerators) {
    const auto start = Clock::now();
    scenes.push_back(std::make_unique<Scene>(description, SceneOptions{accelerator}));
    const double build_seconds = seconds_since(start);
    for (const auto& name : plan.integrators) {
      Candidate& candidate = candidates.emplace_back();
      candidate.integrator_name = name;
      candidate.accelerator_name = scenes.back()->accelerator_name();
      candidate.integrator =
          find_by_name(integrators(), "integrator", name).make(plan.render.integrator_options);
      candidate.scene = scenes.back().get();
      candidate.build_seconds = build_seconds;
      candidate.runs.resize(plan.times.size());
    }
  }
  return candidates;
}

}  // namespace

Image relative_error_map(const Image& x, const Image& reference) {
  Image map(x.width, x.height, 1);
  for (size_t pixel = 0; pixel < map.values.size(); ++pixel) {
    double sum = 0;
    for (size_t c = 0; c < 3; ++c) {
      const double r = reference.values[pixel * 3 + c];
      sum += relative_squared(square(x.values[pixel * 3 + c] - r), r);
    }
    map.values[pixel] = float(std::sqrt(sum / 3));
  }
  return map;
}

SceneConvergence measure_convergence(const ConvergencePlan& plan, size_t index, NoticeLog& log) {
  const std::string& file = plan.scenes[index];
  auto start = Clock::now();
  SceneDescription description = import_scene(file, plan.render.import);
  const auto surroundings = read_surroundings(plan.render.surroundings);
  replace_surroundings(description, surroundings, log);
  const double load_seconds = seconds_since(start);
  log.add(description.notices);
  std::optional<Reference> given;
  if (!plan.references.empty()) given = read_reference(plan.references[index]);

  std::vector<std::unique_ptr<Scene>> scenes;
  std::vector<Candidate> candidates = make_candidates(plan, description, scenes);
  const auto chosen = choose_camera(description.cameras, plan.render.camera, log);
  const CameraDescription view =
      place_camera(chosen, plan.render.camera, scenes.front()->geometry(),
                   bench_aspect(plan.render, given ? &given->picture : nullptr), log);
  RenderSettings options = bench_options(plan.render, view, given ? &given->picture : nullptr);
  for (const auto& scene : scenes) set_environment(*scene, surroundings, view, options, log);
  log.add(scenes.front()->notices());
  const Camera camera(view, options.width, options.height);
  if (!given) fmt::print(stderr, "{}: reference of {} samples a pixel\n", file, plan.reference_spp);
  const Reference reference = given ? std::move(*given)
                                    : render_reference(*scenes.front(), camera, options, plan.reference_spp,
                                                       plan.render.integrator_options.max_depth);

  options.limits.spp = 0;
  for (int seed = 1; seed <= plan.seeds; ++seed) {
    fmt::print(stderr, "{}: seed {} of {}\n", file, seed, plan.seeds);
    options.seed = uint64_t(seed);
    for (size_t t = 0; t < plan.times.size(); ++t) {
      options.limits.seconds = plan.times[t];
      for (Candidate& candidate : candidates)
        candidate.runs[t].push_back(
            measure(candidate, camera, options, reference, t + 1 == plan.times.size()));
    }
  }
  SceneConvergence result;
  result.json = {{"file", file},
                 {"hash", description.hash},
                 {"load_seconds", load_seconds},
                 {"counts", to_json(count(description))},
                 {"camera", view.name},
                 {"width", options.width},
                 {"height", options.height},
                 {"adaptive", options.adaptive},
                 {"reference", reference.json},
                 {"candidates", Json::array()}};
  for (Candidate& candidate : candidates) {
    result.json["candidates"].push_back(candidate_json(candidate, plan, reference));
    result.pictures.push_back(std::move(candidate.pictures));
  }
  result.reference = reference.picture;
  return result;
}

}  // namespace vernier::apps
