// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/denoise_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "integrators/render/picture.h"

namespace vernier {
namespace {

/// The layer `half` of a picture.
struct Halves {
  std::array<Image, 2> color, spread;
};

/// Whether `picture` is the mean of the two halves, but for rounding.
bool is_mean_of(const Image& picture, const Image& first, const Image& second) {
  for (size_t i = 0; i < picture.values.size(); ++i) {
    const float a = first.values[i], b = second.values[i];
    const float tolerance = 1e-5f * (std::abs(a) + std::abs(b));
    if (std::abs(picture.values[i] - (a + b) / 2) > tolerance) return false;
  }
  return true;
}

/// Empty without that layer, and when the picture has changed since.
std::optional<Halves> find_halves(const LayeredImage& picture) {
  Halves halves;
  for (size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "half1" : "half2";
    auto color = picture.layer(name), spread = picture.layer(name + "Spread");
    if (!color || !spread) return std::nullopt;
    halves.color[i] = std::move(*color);
    halves.spread[i] = std::move(*spread);
  }
  if (!is_mean_of(picture.rgb(), halves.color[0], halves.color[1])) return std::nullopt;
  return halves;
}

/// What stratification leaves of the standard errors that independent samples would have: one factor for the
/// picture, by how far its halves are apart.
float left_by_stratification(const Halves& halves) {
  double apart = 0, spread = 0;
  for (size_t i = 0; i < halves.color[0].values.size(); ++i) {
    const double a = halves.color[0].values[i], b = halves.color[1].values[i];
    const double weight = 1 / ((a + b) * (a + b) / 4 + 0.01);
    apart += weight * (a - b) * (a - b);
    for (const Image& half : halves.spread) spread += weight * double(half.values[i]) * half.values[i];
  }
  return spread > 0 ? float(std::min(1.0, std::sqrt(apart / spread))) : 1;
}

/// A half with the picture's guides; `left` is what stratification leaves. Its error is known from itself
/// alone: a guide that knew the other half, as the picture's error layer does, would make the filtered half
/// depend on what it is compared with.
NoisyImage half_of(const NoisyImage& picture, const Halves& halves, size_t which, float left) {
  NoisyImage half = picture;
  half.color = halves.color[which];
  half.error = halves.spread[which];
  for (float& value : half.error->values) value *= left;
  return half;
}

}  // namespace

Denoised denoise(const LayeredImage& picture, const Denoiser& denoiser) {
  const NoisyImage noisy{picture.rgb(), picture.layer("error"), picture.layer("albedo"), picture.layer("N"),
                         coverage_of(picture)};
  const auto halves = find_halves(picture);
  if (!halves) return {denoiser.filter(noisy), std::nullopt, std::nullopt};
  const float left = left_by_stratification(*halves);
  DenoisedHalves denoised =
      denoise_halves(denoiser, half_of(noisy, *halves, 0, left), half_of(noisy, *halves, 1, left));
  return {std::move(denoised.picture), denoised.error, std::move(denoised.pixel_error)};
}

void replace_color(LayeredImage& picture, const Denoised& denoised) {
  for (std::string& name : picture.channel_names)
    if (name.starts_with("error.") && (name != "error.unreliable" || !denoised.pixel_error))
      name = "noisyE" + name.substr(1);
  for (int y = 0; y < picture.image.height; ++y)
    for (int x = 0; x < picture.image.width; ++x)
      std::copy_n(denoised.picture.pixel(x, y), 3, picture.image.pixel(x, y));
  if (denoised.pixel_error) picture.append(*denoised.pixel_error, {"error.R", "error.G", "error.B"});
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

std::optional<DenoisedError> denoise(LayeredImage& picture, const std::string& filter) {
  const Denoiser& denoiser = find_denoiser(filter);
  Denoised denoised = denoise(picture, denoiser);
  replace_color(picture, denoised);
  for (const auto& [name, value] : denoised_metadata(denoiser, denoised.error))
    picture.metadata[name] = value;
  return denoised.error;
}

}  // namespace vernier
