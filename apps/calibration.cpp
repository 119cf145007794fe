#include "apps/calibration.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apps/bench.h"
#include "core/image/metrics.h"

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

}  // namespace

Calibration::Calibration(const Reference& reference, double asked)
    : reference_(reference), asked_(asked), decile_of_pixel_(deciles_by_luminance(reference.picture)) {}

void Calibration::add(const RenderResult& result) {
  const vernier::Image picture = result.film.image();
  const ErrorLayers layers = error_layers(result.film);
  Deciles& deciles = deciles_.emplace_back();
  for (size_t pixel = 0; pixel < decile_of_pixel_.size(); ++pixel) {
    ++pixels_;
    if (layers.unreliable.values[pixel] > 0) {
      ++flagged_;
      continue;
    }
    for (size_t i = pixel * 3; i < pixel * 3 + 3; ++i)
      add_value(i, picture.values[i], layers.standard_error.values[i], deciles[decile_of_pixel_[pixel]]);
  }
  const double truth = difference(picture, reference_.picture).rel_mse - reference_.rel_mse;
  images_.push_back({result.error.rel_rmse, result.error.low, result.error.high,
                     std::sqrt(std::max(0.0, truth)),
                     double(result.samples) / double(decile_of_pixel_.size())});
}

void Calibration::add_value(size_t i, double value, double error, Decile& sums) {
  const double reference = reference_.picture.values[i], difference = value - reference;
  // Both wander about the truth.
  const double variance = square(error) + square(double(reference_.standard_error.values[i]));
  ++values_;
  for (size_t k = 0; k < nominal_coverages.size(); ++k)
    covered_[k] += difference * difference <= square(nominal_coverages[k].deviations) * variance;
  sums.predicted += relative_squared(variance, reference);
  sums.actual += relative_squared(difference * difference, reference);
  ++sums.values;
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

Json Calibration::json() const {
  Json coverage = Json::array();
  for (size_t i = 0; i < nominal_coverages.size(); ++i)
    coverage.push_back(
        {{"nominal", nominal_coverages[i].part}, {"measured", ratio(double(covered_[i]), double(values_))}});
  std::vector<double> estimated, truths, ratios, samples;
  size_t inside = 0, above_estimate = 0, above_asked = 0;
  double estimated_squares = 0, true_squares = 0;
  for (const Image& image : images_) {
    estimated.push_back(image.estimated);
    truths.push_back(image.truth);
    ratios.push_back(image.estimated / image.truth);
    samples.push_back(image.samples_per_pixel);
    estimated_squares += square(image.estimated);
    true_squares += square(image.truth);
    inside += image.low <= image.truth && image.truth <= image.high;
    above_estimate += image.truth > 1.1 * image.estimated;
    above_asked += image.truth > 1.1 * asked_;
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
            {"true_above_1.1_asked", asked_ > 0 ? Json(above_asked) : Json(nullptr)}}}};
}

}  // namespace vernier::apps
