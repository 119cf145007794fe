// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/display/display.h"
#include "core/image/image_io.h"
#include "integrators/render/render.h"

// A render as a picture file.

namespace vernier {

/// Samples a pixel, on average.
double samples_per_pixel(const RenderResult& result);

/// Header entries that say what was sampled, and how wrong it is.
Metadata result_metadata(const RenderResult& result);

/// Whether a file is written as display values (PNG, JPEG) rather than scene-linear ones (EXR). By extension.
bool is_display_file(const std::string& path);

/// The bytes of a file of that format, "exr", "png" or "jpg", as write_picture() makes it.
std::vector<unsigned char> encode_picture(const std::string& format, const LayeredImage& picture,
                                          Metadata metadata, const DisplayOptions& display);

/// `picture` has the color first and then layers, which only .exr files get. Display files are shown as
/// `display` says; their headers tell how. Throws Error(output).
void write_picture(const std::string& path, const LayeredImage& picture, Metadata metadata,
                   const DisplayOptions& display);

}  // namespace vernier
