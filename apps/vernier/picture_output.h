// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "apps/vernier/render_options.h"
#include "core/image/image_io.h"

// Pictures go to files, or to standard output.

namespace vernier::apps {

/// "-" stands for standard input or output.
inline bool is_standard_stream(const std::string& file) { return file == "-"; }

/// What the header of a picture that is still on its way says it was stopped by.
inline constexpr const char* unfinished = "unfinished";

/// The output by a name that tells its format. `format` as in RunFlags.
std::string named_output(const std::string& output, const std::string& format);

/// Whether an output holds display values (PNG, JPEG) rather than scene-linear ones (EXR). `format` as in
/// RunFlags.
bool is_display_output(const std::string& output, const std::string& format);

/// Throws Error unless an output can be written; called before rendering. `folder_is_made`: its folder need
/// not be there.
void check_output(const std::string& output, bool folder_is_made);

/// Makes the folders that are missing for a file. Throws Error(output).
void make_folder_of(const std::string& file);

/// Writes the picture as the request has it. Throws Error(output).
void write_output(const std::string& output, const LayeredImage& picture, const Metadata& metadata,
                  const RenderRequest& request);

/// Whether a picture is there and was finished: one that was stopped early or is still on its way says so in
/// its header.
bool is_finished_picture(const std::string& file);

}  // namespace vernier::apps
