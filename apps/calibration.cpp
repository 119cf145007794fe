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
  for (size_t pixel = 0; pixel < decile_of_pixel_.size(); ++pixel) {
    ++pixels_;
    if (layers.unreliable.values[pixel] > 0) {
      ++flagged_;
      continue;
    }
    for (size_t i = pixel * 3; i < pixel * 3 + 3; ++i)
      add_value(double(picture.values[i]) - reference_.picture.values[i], layers.standard_error.values[i],
                reference_.standard_error.values[i], decile_of_pixel_[pixel]);
  }
  const double truth = difference(picture, reference_.picture).rel_mse - reference_.rel_mse;
  images_.push_back({result.error.rel_rmse, result.error.low, result.error.high,
                     std::sqrt(std::max(0.0, truth)),
                     double(result.samples) / double(decile_of_pixel_.size())});
}

void Calibration::add_value(double difference, double error, double reference_error, size_t decile) {
  // Both wander about the truth.
  const double variance = error * error + reference_error * reference_error;
  ++values_;
  for (size_t i = 0; i < nominal_coverages.size(); ++i)
    covered_[i] += difference * difference <= square(nominal_coverages[i].deviations) * variance;
  Decile& sums = deciles_[decile];
  sums.predicted += variance;
  sums.actual += difference * difference;
  ++sums.values;
}

Json Calibration::json() const {
  Json coverage = Json::array(), deciles = Json::array();
  for (size_t i = 0; i < nominal_coverages.size(); ++i)
    coverage.push_back(
        {{"nominal", nominal_coverages[i].part}, {"measured", ratio(double(covered_[i]), double(values_))}});
  for (const Decile& sums : deciles_)
    deciles.push_back({{"values", sums.values},
                       {"predicted_over_actual", ratio(std::sqrt(sums.predicted), std::sqrt(sums.actual))}});
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
          {"deciles", deciles},
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
