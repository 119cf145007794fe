// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "apps/report/html_page.h"
#include "vernier/image.h"

// Pieces that several pages are made of.

namespace vernier::apps {

/// Side of the square blocks that a picture must be averaged in until neither side is longer than `longest`.
int shrink_factor(const Image& image, int longest);

/// Pixels averaged in blocks of that size.
Image shrink(const Image& image, int longest);

/// Part of `image`.
Image cut(const Image& image, int x, int y, int width, int height);

/// One channel: square root of the channels' mean squared relative standard error, as --error counts it.
Image relative_error(const Image& picture, const Image& error);

/// A round number, 1, 2 or 5 times a power of ten, that at least 99 of 100 values do not exceed; 1 when all
/// are zero. Values that are not finite do not count.
double round_scale(const Image& map);

/// A one-channel map in colours, with a caption that tells what dark and pale stand for:
/// "CAPTION. Black 0, pale yellow 20 % and more."
Figure map_figure(const Image& map, double largest, std::string_view caption, bool as_percent);

/// From the first drawn point of `curve` to its last abscissa, falling as one over the square root: the error
/// of sampling without bias.
Curve square_root_guide(const Curve& curve);

/// The machine and what the program was built with, from those parts of docs/stats.md.
void add_machine(HtmlPage& page, const nlohmann::ordered_json& machine,
                 const nlohmann::ordered_json& built_with);

}  // namespace vernier::apps
