#include "apps/denoising.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace vernier::apps {
namespace {

/// Whether `picture` is the mean of the two halves, but for rounding.
bool is_mean_of(const Image& picture, const Image& first, const Image& second) {
  for (size_t i = 0; i < picture.values.size(); ++i) {
    const float a = first.values[i], b = second.values[i];
    const float tolerance = 1e-5f * (std::abs(a) + std::abs(b));
    if (std::abs(picture.values[i] - (a + b) / 2) > tolerance) return false;
  }
  return true;
}

/// The same guides for one half, whose error is larger than that of the mean of two.
NoisyImage half_of(const NoisyImage& picture, const Image& color) {
  NoisyImage half = picture;
  half.color = color;
  if (half.error)
    for (float& value : half.error->values) value *= std::numbers::sqrt2_v<float>;
  return half;
}

}  // namespace

Denoised denoise(const LayeredImage& picture, const Denoiser& denoiser) {
  const NoisyImage noisy{picture.rgb(), picture.layer("error"), picture.layer("albedo"), picture.layer("N")};
  const auto first = picture.layer("half1"), second = picture.layer("half2");
  if (!first || !second || !is_mean_of(noisy.color, *first, *second))
    return {denoiser.filter(noisy), std::nullopt, std::nullopt};
  DenoisedHalves halves = denoise_halves(denoiser, half_of(noisy, *first), half_of(noisy, *second));
  return {std::move(halves.picture), halves.error, std::move(halves.pixel_error)};
}

void put_into(LayeredImage& picture, const Denoised& denoised) {
  for (std::string& name : picture.channel_names)
    if (name.starts_with("error.") && (name != "error.unreliable" || !denoised.pixel_error))
      name = "noisyE" + name.substr(1);
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      std::copy_n(denoised.picture.pixel(x, y), 3, picture.image.pixel(x, y));
  if (denoised.pixel_error) picture.append(*denoised.pixel_error, {"error.R", "error.G", "error.B"});
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

Metadata denoised_metadata(const Denoiser& denoiser, const std::optional<DenoisedError>& error) {
  Metadata metadata{{"vernier:denoiser", std::string(denoiser.name)}};
  if (error) {
    metadata["vernier:denoisedRelRmse"] = fmt::format("{:.6g}", error->rel_rmse);
    metadata["vernier:denoisedRelRmse95"] = fmt::format("{:.6g} {:.6g}", error->low, error->high);
    metadata["vernier:relRmseBeforeDenoising"] = fmt::format("{:.6g}", error->noisy);
  }
  return metadata;
}

}  // namespace vernier::apps
