// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "core/image/image_io.h"

// How OpenEXR files are stored, as every command that writes such files takes it.

namespace vernier::apps {

/// --half, --multipart and --compression.
void add_exr_flags(CLI::App& command, ExrOptions& options);

/// Throws Error(usage) when such a flag is given and none of the outputs is an .exr, or when values that
/// other programs calculate with, `has_layers`, would be compressed with loss.
void check_exr_flags(const ExrOptions& options, const std::vector<std::string>& outputs, bool has_layers);

/// "3 values are above 65504 ...", a warning when --half cannot hold what the picture has; empty otherwise.
std::string half_warning(const ExrOptions& options, const LayeredImage& picture);

}  // namespace vernier::apps
