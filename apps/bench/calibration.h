// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>

#include "apps/bench/bench_reference.h"
#include "integrators/render/render.h"

// How far the errors that renders report agree with those that they have (`vernier bench calibration`).

namespace vernier::apps {

/// Nominal coverages, and how many standard deviations on either side of a normal variable have them.
struct NominalCoverage {
  double part, deviations;
};
constexpr std::array<NominalCoverage, 4> nominal_coverages{
    {{0.50, 0.674490}, {0.90, 1.644854}, {0.95, 1.959964}, {0.99, 2.575829}}};

/// What one render says, of itself and of its error.
struct CalibrationRun {
  explicit CalibrationRun(const RenderResult& result);

  Image picture;
  Image coverage;  ///< Film::coverage()
  ErrorLayers layers;
  ErrorEstimate error;
  double samples_per_pixel;
};

/// Fewest runs that calibrate() can do with when it is given no reference.
constexpr int fewest_runs_without_reference = 3;

/// Compares the reported errors of renders of one picture, which differ in their seeds, with those that they
/// have against `reference`, which has an error layer; without one, each against the mean of the others. What
/// either is itself wrong by is taken off. `asked`: the error at which each render was told to stop; 0: none.
/// The result: docs/bench.md, `vernier bench calibration`.
nlohmann::ordered_json calibrate(std::span<const CalibrationRun> runs,
                                 const std::optional<Reference>& reference, double asked);

}  // namespace vernier::apps
