// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/missing_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace vernier::apps {
namespace {

nlohmann::ordered_json figure_json(const MissingFigure& figure) {
  return {{"share", figure.share}, {"rel_rmse", figure.rel_rmse}};
}

std::string percent(double share) {
  return fmt::format(fmt::runtime(share < 0.1 ? "{:.2g} %" : "{:.0f} %"), 100 * share);
}

}  // namespace

std::string missing_text(const MissingEstimate& missing) {
  std::string text;
  if (missing.bent.share >= least_missing_share)
    text += fmt::format(" + up to {} of all light missing behind glass", percent(missing.bent.share));
  if (missing.depth.share >= least_missing_share)
    text += fmt::format(" + {} of all light missing beyond the depth limit", percent(missing.depth.share));
  return text;
}

void warn_of_missing_light(const RenderResult& result, int max_depth, NoticeLog& log) {
  const MissingEstimate& missing = result.missing;
  if (missing.bent.share >= least_missing_share) {
    const bool has_caustics = result.light_path_kind == LightPathKind::caustics;
    log.add(
        {Notice::Severity::warning,
         {},
         fmt::format("lamps shine through glass that bends their light{}: up to {} of all light is not in "
                     "this picture and not in its error; {}",
                     has_caustics ? ", by lobes of some width or by normal textures" : "",
                     percent(missing.bent.share),
                     has_caustics ? "an emissive mesh in place of the lamp, or glass without thickness, is "
                                    "rendered in full"
                                  : "--integrator path with --caustics auto brings it")});
  }
  if (missing.depth.share >= least_missing_share)
    log.add(
        {Notice::Severity::warning,
         {},
         fmt::format("the depth limit cuts off {} of all light, which is not in the error: --max-depth {} "
                     "finds more",
                     percent(missing.depth.share), 4 * max_depth)});
}

nlohmann::ordered_json missing_json(const MissingEstimate& missing) {
  return {{"bent", figure_json(missing.bent)}, {"depth", figure_json(missing.depth)}};
}

bool exceeds(const MissingEstimate& missing, double target_error) {
  return std::max(missing.bent.rel_rmse, missing.depth.rel_rmse) > target_error;
}

}  // namespace vernier::apps
