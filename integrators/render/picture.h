// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/display/display.h"
#include "core/image/image_io.h"
#include "integrators/render/render.h"

// A render as a picture file.

namespace vernier {

/// Samples a pixel, on average.
double samples_per_pixel(const RenderResult& result);

RenderStatus status_of(const RenderResult& result);

/// Header entries that say what was sampled, and how wrong it is.
Metadata result_metadata(const RenderResult& result);

/// Whether a file is written as display values (PNG, JPEG) rather than scene-linear ones (EXR). By extension.
bool is_display_file(const std::string& path);

/// Throws Error(usage) unless a file of that kind, by its extension, holds alpha.
void require_alpha_fits(const std::string& path);
/// The same, if the picture is not opaque.
void require_alpha_fits(const LayeredImage& picture, const std::string& path);

/// One channel; empty where the picture is opaque, which other programs' alpha often says.
std::optional<Image> alpha_of(const LayeredImage& picture);

/// R, G and B, and A if it has one, without layers and texts.
LayeredImage color_and_alpha(const LayeredImage& picture);

/// One channel: where it is 0, the picture shows no surface. Its layer `coverage`, else its alpha; empty
/// without either.
std::optional<Image> coverage_of(const LayeredImage& picture);

/// `picture` has the color first and then layers, which only .exr files get, as they do the texts of its own
/// header that `metadata` does not have; alpha is written associated to .exr and straight to .png. Display
/// files are shown as `display` says; their headers tell how. Throws Error(output), and Error(usage) as
/// require_alpha_fits().
void write_picture(const std::string& path, const LayeredImage& picture, Metadata metadata,
                   const DisplayOptions& display, const ExrOptions& exr = {});
/// The bytes of such a file; `format` is "exr", "png" or "jpg".
std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          Metadata metadata, const DisplayOptions& display,
                                          const ExrOptions& exr = {});

}  // namespace vernier
