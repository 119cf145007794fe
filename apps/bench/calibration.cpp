// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/calibration.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/bench/bench.h"
#include "core/compare/metrics.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

std::vector<uint8_t> deciles_by_luminance(const Image& picture) {
  const size_t pixels = size_t(picture.width) * picture.height;
  std::vector<size_t> order(pixels);
  std::iota(order.begin(), order.end(), size_t{0});
  const auto brightness = [&](size_t i) {
    const float* p = &picture.values[i * 3];
    return luminance({p[0], p[1], p[2]});
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return brightness(a) < brightness(b); });
  std::vector<uint8_t> deciles(pixels);
  for (size_t rank = 0; rank < pixels; ++rank) deciles[order[rank]] = uint8_t(rank * 10 / pixels);
  return deciles;
}

Json ratio(double a, double b) { return b > 0 ? Json(a / b) : Json(nullptr); }

/// What a run is compared with.
struct Truth {
  Image value;
  Image variance;  ///< of each value
  Image scale;     ///< what errors are relative to
};

Truth truth_by(const Reference& reference) {
  Truth truth{reference.picture, reference.standard_error, reference.picture};
  for (float& value : truth.variance.values) value *= value;
  return truth;
}

/// Sums over all runs, from which the mean of all but one and its variance are known.
class MeanOfOthers {
 public:
  explicit MeanOfOthers(std::span<const CalibrationRun> runs)
      : count_(double(runs.size())),
        sums_(runs.front().picture.values.size()),
        squares_(sums_.size()),
        mean_(runs.front().picture) {
    for (const CalibrationRun& run : runs)
      for (size_t i = 0; i < sums_.size(); ++i) {
        sums_[i] += run.picture.values[i];
        squares_[i] += square(double(run.picture.values[i]));
      }
    for (size_t i = 0; i < sums_.size(); ++i) mean_.values[i] = float(sums_[i] / count_);
  }

  /// Of all: light that one run alone has found would else be relative to none.
  const Image& mean() const { return mean_; }

  Truth without(const CalibrationRun& run) const {
    Truth truth{mean_, mean_, mean_};
    const double others = count_ - 1;
    for (size_t i = 0; i < sums_.size(); ++i) {
      const double own = run.picture.values[i], mean = (sums_[i] - own) / others;
      const double spread = (squares_[i] - own * own) / others - mean * mean;
      truth.value.values[i] = float(mean);
      truth.variance.values[i] = float(std::max(0.0, spread) / (others - 1));
    }
    return truth;
  }

 private:
  double count_;
  std::vector<double> sums_, squares_;
  Image mean_;
};

/// Sums of squared errors relative to r^2 + 0.01.
struct Decile {
  double predicted = 0, actual = 0;
  size_t values = 0;
};
using Deciles = std::array<Decile, 10>;

/// Adds up runs.
class Calibration {
 public:
  explicit Calibration(const Image& picture) : decile_of_pixel_(deciles_by_luminance(picture)) {}

  void add(const CalibrationRun& run, const Truth& truth);
  Json json(double asked) const;

 private:
  struct ImageFigures {
    double estimated, low, high, truth, samples_per_pixel;
  };
  Json deciles_json() const;

  std::vector<uint8_t> decile_of_pixel_;  ///< by luminance
  std::vector<Deciles> deciles_;          ///< of each run
  std::array<size_t, nominal_coverages.size()> covered_{};
  size_t values_ = 0, pixels_ = 0, flagged_ = 0;
  std::vector<ImageFigures> images_;
};

void Calibration::add(const CalibrationRun& run, const Truth& truth) {
  Deciles& deciles = deciles_.emplace_back();
  const bool counts_all = std::none_of(run.coverage.values.begin(), run.coverage.values.end(),
                                       [](float covered) { return covered > 0; });
  double image = 0;
  size_t counted = 0;
  for (size_t i = 0; i < run.picture.values.size(); ++i) {
    const size_t pixel = i / 3;
    const double scale = truth.scale.values[i];
    const double squared = square(double(run.picture.values[i]) - truth.value.values[i]);
    if (counts_all || run.coverage.values[pixel] > 0) {
      image += relative_squared(squared - truth.variance.values[i], scale);
      ++counted;
    }
    if (run.layers.unreliable.values[pixel] > 0) continue;
    // Both wander about the truth.
    const double variance = square(run.layers.standard_error.values[i]) + truth.variance.values[i];
    ++values_;
    for (size_t k = 0; k < nominal_coverages.size(); ++k)
      covered_[k] += squared <= square(nominal_coverages[k].deviations) * variance;
    Decile& sums = deciles[decile_of_pixel_[pixel]];
    sums.predicted += relative_squared(variance, scale);
    sums.actual += relative_squared(squared, scale);
    ++sums.values;
  }
  pixels_ += run.layers.unreliable.values.size();
  for (const float flag : run.layers.unreliable.values) flagged_ += flag > 0;
  const double mean = image / double(counted);
  images_.push_back({run.error.rel_rmse, run.error.low, run.error.high, std::sqrt(std::max(0.0, mean)),
                     run.samples_per_pixel});
}

/// Of the sums over all runs; the standard error from leaving out one run after the other (jackknife).
Json Calibration::deciles_json() const {
  Json json = Json::array();
  for (size_t d = 0; d < std::tuple_size_v<Deciles>; ++d) {
    Decile total;
    for (const Deciles& run : deciles_) {
      total.predicted += run[d].predicted;
      total.actual += run[d].actual;
      total.values += run[d].values;
    }
    const double n = double(deciles_.size());
    double sum = 0, squares = 0;
    for (const Deciles& run : deciles_) {
      const double without = std::sqrt((total.predicted - run[d].predicted) / (total.actual - run[d].actual));
      sum += without;
      squares += square(without);
    }
    const double spread = std::sqrt(std::max(0.0, (squares - square(sum) / n) * (n - 1) / n));
    json.push_back({{"values", total.values},
                    {"predicted_over_actual", ratio(std::sqrt(total.predicted), std::sqrt(total.actual))},
                    {"standard_error", n > 1 && std::isfinite(spread) ? Json(spread) : Json(nullptr)}});
  }
  return json;
}

Json Calibration::json(double asked) const {
  Json coverage = Json::array();
  for (size_t i = 0; i < nominal_coverages.size(); ++i)
    coverage.push_back(
        {{"nominal", nominal_coverages[i].part}, {"measured", ratio(double(covered_[i]), double(values_))}});
  std::vector<double> estimated, truths, ratios, samples;
  size_t inside = 0, above_estimate = 0, above_asked = 0;
  double estimated_squares = 0, true_squares = 0;
  for (const ImageFigures& image : images_) {
    estimated.push_back(image.estimated);
    truths.push_back(image.truth);
    ratios.push_back(image.estimated / image.truth);
    samples.push_back(image.samples_per_pixel);
    estimated_squares += square(image.estimated);
    true_squares += square(image.truth);
    inside += image.low <= image.truth && image.truth <= image.high;
    above_estimate += image.truth > 1.1 * image.estimated;
    above_asked += image.truth > 1.1 * asked;
  }
  const auto [lowest, highest] = std::minmax_element(ratios.begin(), ratios.end());
  return {{"runs", images_.size()},
          {"samples_per_pixel", median(samples)},
          {"flagged", ratio(double(flagged_), double(pixels_))},
          {"coverage", coverage},
          {"deciles", deciles_json()},
          {"image",
           {{"estimated", median(estimated)},
            {"true", median(truths)},
            {"ratio", {{"median", median(ratios)}, {"low", *lowest}, {"high", *highest}}},
            {"ratio_of_means", ratio(std::sqrt(estimated_squares), std::sqrt(true_squares))},
            {"interval_covers", double(inside) / double(images_.size())},
            {"true_above_1.1_estimated", above_estimate},
            {"true_above_1.1_asked", asked > 0 ? Json(above_asked) : Json(nullptr)}}}};
}

}  // namespace

CalibrationRun::CalibrationRun(const RenderResult& result)
    : picture(result.film.image()),
      coverage(result.film.coverage()),
      layers(error_layers(result.film)),
      error(result.error),
      samples_per_pixel(double(result.samples) / (double(result.film.width()) * result.film.height())) {}

Json calibrate(std::span<const CalibrationRun> runs, const std::optional<Reference>& reference,
               double asked) {
  if (reference) {
    Calibration calibration(reference->picture);
    const Truth truth = truth_by(*reference);
    for (const CalibrationRun& run : runs) calibration.add(run, truth);
    return calibration.json(asked);
  }
  const MeanOfOthers others(runs);
  Calibration calibration(others.mean());
  for (const CalibrationRun& run : runs) calibration.add(run, others.without(run));
  return calibration.json(asked);
}

}  // namespace vernier::apps
