// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

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

bool is_display_file(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension != ".exr";
}

void write_picture(const std::string& path, const LayeredImage& picture, Metadata metadata,
                   const DisplayOptions& display) {
  if (!is_display_file(path)) {
    write_exr(path, picture.image, picture.channel_names, metadata);
    return;
  }
  add_display(metadata, display);
  write_image8(path, to_display(picture.rgb(), display), metadata);
}

std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          Metadata metadata, const DisplayOptions& display) {
  if (format == "exr") return encode_exr(picture.image, picture.channel_names, metadata);
  add_display(metadata, display);
  return encode_image8(format, to_display(picture.rgb(), display), metadata);
}

}  // namespace vernier
