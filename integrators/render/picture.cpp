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

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

bool holds_alpha(const std::string& path) {
  const std::string extension = extension_of(path);
  return extension == ".exr" || extension == ".png";
}

/// What a display file of that name shows.
Image8 displayed(const std::string& path, const LayeredImage& picture, const DisplayOptions& display) {
  require_alpha_fits(picture, path);
  return to_display(holds_alpha(path) ? color_and_alpha(picture).image : picture.rgb(), display);
}

}  // namespace

double samples_per_pixel(const RenderResult& result) {
  return double(result.samples) / (double(result.film.width()) * result.film.height());
}

RenderStatus status_of(const RenderResult& r) {
  return {r.seconds,
          samples_per_pixel(r),
          r.samples,
          r.rays,
          r.error,
          r.missing,
          r.bad_samples + r.bad_light_paths};
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
  if (result.film.is_reconstructed()) metadata["vernier:reconstruction"] = "gradient-domain";
  metadata["vernier:missingBentLight"] = fmt::format("{:.6g}", result.missing.bent.share);
  metadata["vernier:missingBeyondDepth"] = fmt::format("{:.6g}", result.missing.depth.share);
  return metadata;
}

bool is_display_file(const std::string& path) { return extension_of(path) != ".exr"; }

void require_alpha_fits(const std::string& path) {
  if (!holds_alpha(path))
    throw Error(ErrorKind::usage, path, {},
                "this kind of file has no alpha, and the picture is transparent; use .png or .exr, or "
                "'render' or 'develop' with --background");
}

void require_alpha_fits(const LayeredImage& picture, const std::string& path) {
  if (alpha_of(picture)) require_alpha_fits(path);
}

std::optional<Image> alpha_of(const LayeredImage& picture) {
  auto alpha = picture.single("A");
  const auto is_opaque = [](float value) { return value == 1; };
  if (alpha && std::all_of(alpha->values.begin(), alpha->values.end(), is_opaque)) alpha.reset();
  return alpha;
}

LayeredImage color_and_alpha(const LayeredImage& picture) {
  LayeredImage result{picture.rgb(), {"R", "G", "B"}, {}, picture.linear, picture.place};
  if (const auto alpha = picture.single("A")) result.append(*alpha, {"A"});
  return result;
}

std::optional<Image> coverage_of(const LayeredImage& picture) {
  auto coverage = picture.single("coverage");
  return coverage ? coverage : alpha_of(picture);
}

namespace {

/// In the picture's place.
ExrOptions placed(ExrOptions options, const LayeredImage& picture) {
  options.place = picture.place;
  return options;
}

}  // namespace

void write_picture(const std::string& path, const LayeredImage& picture, Metadata metadata,
                   const DisplayOptions& display, const ExrOptions& exr) {
  if (!is_display_file(path)) {
    metadata.insert(picture.metadata.begin(), picture.metadata.end());
    write_exr(path, picture.image, picture.channel_names, metadata, placed(exr, picture));
    return;
  }
  add_display(metadata, display);
  write_image8(path, displayed(path, picture, display), metadata);
}

std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          Metadata metadata, const DisplayOptions& display,
                                          const ExrOptions& exr) {
  if (format == "exr") {
    metadata.insert(picture.metadata.begin(), picture.metadata.end());
    return encode_exr(picture.image, picture.channel_names, metadata, placed(exr, picture));
  }
  add_display(metadata, display);
  return encode_image8(format, displayed("picture." + format, picture, display), metadata);
}

Image8 to_display(const LayeredImage& picture, const DisplayOptions& options) {
  const DisplayOptions chosen = with_chosen_view(options);
  return to_display(alpha_of(picture) ? color_and_alpha(picture).image : picture.rgb(), chosen);
}

LayeredImage read_picture(const std::string& path) {
  LayeredImage picture = read_layers(path);
  if (picture.linear) return picture;
  picture.metadata = read_image_texts(path).value_or(Metadata{});
  picture.metadata.erase("ImageDescription");  // its lines are texts by themselves
  return picture;
}

void write_picture(const std::string& path, const LayeredImage& picture, const DisplayOptions& display) {
  check_image_name(path);
  const bool is_shown = is_display_file(path);
  write_picture(path, picture, picture.metadata, is_shown ? with_chosen_view(display) : display);
}

std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          const DisplayOptions& display) {
  const bool is_shown = format != "exr";
  return encode_picture(format, picture, picture.metadata, is_shown ? with_chosen_view(display) : display);
}

}  // namespace vernier
