// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/comparison.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/base/names.h"
#include "core/image/image_io.h"
#include "vernier/error.h"

namespace vernier::apps {

Comparison compare_files(const std::string& picture, const std::string& reference,
                         const ComparisonOptions& options) {
  const LayeredImage x = read_layers(picture), r = read_layers(reference);
  return compare({picture, x}, {reference, r}, options);
}

Limit::Limit(const std::string& text) {
  const size_t sign = text.find_first_of("<>");
  above_ = sign != std::string::npos && text[sign] == '>';
  const char* end = text.data() + text.size();
  const char* begin = sign == std::string::npos ? end : text.data() + sign + 1;
  const auto [stopped, status] = std::from_chars(begin, end, bound_);
  if (status != std::errc() || stopped != end || std::isnan(bound_))
    throw Error(ErrorKind::usage, {}, "--fail",
                fmt::format("expected METRIC>NUMBER or METRIC<NUMBER such as 'rmse>0.01', got '{}'", text));
  metric_ = &find_by_name(metrics(), "metric", text.substr(0, sign));
}

std::string Limit::complaint(const Comparison& comparison) const {
  const auto value = metric_->value(comparison);
  if (!value)
    throw Error(ErrorKind::usage, {}, "--fail",
                fmt::format("{} was not measured: {}", metric_->name,
                            metric_->name == "flip"    ? "--no-flip was given"
                            : metric_->name == "alpha" ? "the pictures have no alpha"
                                                       : "a file has no error layer"));
  if (above_ ? *value <= bound_ : *value >= bound_) return {};
  return fmt::format("{} is {:.6g}, {} {:.6g}", metric_->name, *value, above_ ? "above" : "below", bound_);
}

}  // namespace vernier::apps
