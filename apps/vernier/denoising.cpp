// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/denoising.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/denoise/oidn_library.h"

namespace vernier::apps {

bool print_requested_denoisers(const std::string& filter) {
  if (filter != "help") return false;
  for (const Denoiser& entry : denoisers()) fmt::print("{:<12} {}\n", entry.name, entry.description);
  if (!OidnLibrary::find()) fmt::print("{:<12} not here: {}\n", "oidn", OidnLibrary::why_not_found());
  fmt::print("{:<12} oidn where it is found, else {}\n", "auto", denoisers().front().name);
  return true;
}

std::string denoised_text(const Denoiser& denoiser, const std::optional<DenoisedError>& error) {
  if (!error) return fmt::format("denoised by {}: error not known without halves", denoiser.name);
  return fmt::format("denoised by {}: error {:.3g} % ({:.3g} to {:.3g} %), {:.3g} % before", denoiser.name,
                     100 * error->rel_rmse, 100 * error->low, 100 * error->high, 100 * error->noisy);
}

nlohmann::ordered_json denoised_json(const Denoiser& denoiser, const std::optional<DenoisedError>& error) {
  nlohmann::ordered_json json{{"filter", denoiser.name}};
  if (error)
    json.update({{"rel_rmse", error->rel_rmse},
                 {"low", error->low},
                 {"high", error->high},
                 {"confidence", 0.95},
                 {"rel_rmse_before", error->noisy}});
  return json;
}

}  // namespace vernier::apps
