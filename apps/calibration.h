#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "apps/bench_reference.h"
#include "integrators/render.h"

// How far the errors that renders report agree with those that they have (`vernier bench calibration`).

namespace vernier::apps {

/// Nominal coverages, and how many standard deviations on either side of a normal variable have them.
struct NominalCoverage {
  double part, deviations;
};
constexpr std::array<NominalCoverage, 4> nominal_coverages{
    {{0.50, 0.674490}, {0.90, 1.644854}, {0.95, 1.959964}, {0.99, 2.575829}}};

/// Adds up many renders of one picture, which differ in their seeds, against a reference with error layer.
class Calibration {
 public:
  /// `asked`: the error at which each render was told to stop; 0: none.
  explicit Calibration(const Reference& reference, double asked = 0);

  void add(const RenderResult& result);

  /// docs/bench.md, `vernier bench calibration`.
  nlohmann::ordered_json json() const;

 private:
  /// Sums of squared errors relative to r^2 + 0.01.
  struct Decile {
    double predicted = 0, actual = 0;
    size_t values = 0;
  };
  using Deciles = std::array<Decile, 10>;
  struct Image {
    double estimated, low, high, truth, samples_per_pixel;
  };
  /// Value `i` of the pictures, three a pixel, known with this `error`.
  void add_value(size_t i, double value, double error, Decile& sums);
  nlohmann::ordered_json deciles_json() const;

  const Reference& reference_;
  const double asked_;
  std::vector<uint8_t> decile_of_pixel_;  ///< by luminance of the reference
  std::vector<Deciles> deciles_;          ///< of each run
  std::array<size_t, nominal_coverages.size()> covered_{};
  size_t values_ = 0, pixels_ = 0, flagged_ = 0;
  std::vector<Image> images_;
};

}  // namespace vernier::apps
