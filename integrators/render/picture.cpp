// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "vernier/error.h"
#include "vernier/version.h"

namespace vernier {
namespace {

void add_display(Metadata& metadata, const DisplayOptions& display) {
  metadata["vernier:exposure"] = fmt::format("{}", display.exposure);
  metadata["vernier:view"] = display.view;
}

}  // namespace

double samples_per_pixel(const RenderResult& result) {
  return double(result.samples) / (double(result.film.width()) * result.film.height());
}

Metadata result_metadata(const RenderResult& result) {
  Metadata metadata = {{"Software", fmt::format("vernier {}", version())},
                       {"vernier:samples", fmt::format("{}", result.samples)},
                       {"vernier:samplesPerPixel", fmt::format("{}", samples_per_pixel(result))}};
  if (std::isfinite(result.error.rel_rmse)) {
    metadata["vernier:relRmse"] = fmt::format("{:.6g}", result.error.rel_rmse);
    metadata["vernier:relRmse95"] = fmt::format("{:.6g} {:.6g}", result.error.low, result.error.high);
    metadata["vernier:unreliablePixels"] = fmt::format("{:.6g}", result.error.unreliable);
  }
  metadata["vernier:missingBentLight"] = fmt::format("{:.6g}", result.missing.bent.share);
  metadata["vernier:missingBeyondDepth"] = fmt::format("{:.6g}", result.missing.depth.share);
  return metadata;
}

namespace {

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

}  // namespace

bool is_display_file(const std::string& path) { return extension_of(path) != ".exr"; }

void require_alpha_fits(const std::string& path) {
  const std::string extension = extension_of(path);
  if (extension != ".exr" && extension != ".png")
    throw Error(ErrorKind::usage, path, {},
                "this kind of file has no alpha, and the picture is transparent; use .png or .exr, or "
                "'render' or 'develop' with --background");
}

LayeredImage color_and_alpha(const LayeredImage& picture) {
  LayeredImage result{picture.rgb(), {"R", "G", "B"}, {}, picture.linear};
  if (const auto alpha = picture.single("A")) result.append(*alpha, {"A"});
  return result;
}

std::optional<Image> coverage_of(const LayeredImage& picture) {
  auto coverage = picture.single("coverage");
  return coverage ? coverage : picture.single("A");
}

void write_picture(const std::string& path, const LayeredImage& picture, Metadata metadata,
                   const DisplayOptions& display) {
  if (!is_display_file(path)) {
    write_exr(path, picture.image, picture.channel_names, metadata);
    return;
  }
  add_display(metadata, display);
  const LayeredImage shown = color_and_alpha(picture);
  if (shown.image.channels > 3) require_alpha_fits(path);
  write_image8(path, to_display(shown.image, display), metadata);
}

std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          Metadata metadata, const DisplayOptions& display) {
  if (format == "exr") return encode_exr(picture.image, picture.channel_names, metadata);
  add_display(metadata, display);
  return encode_image8(format, to_display(color_and_alpha(picture).image, display), metadata);
}

}  // namespace vernier
