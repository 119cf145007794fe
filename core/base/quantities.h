// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

// Quantities as people type them. Each parser takes the whole text or throws Error(usage) that says what it
// expected.

namespace vernier {

struct PixelSize {
  int width = 0, height = 0;
};

/// Pixels [x, x + width) x [y, y + height).
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Seconds, greater than zero, from "90s", "10m", "1.5h", "1h30m", or a bare number of seconds.
double parse_seconds(std::string_view text);

/// A part of the whole, above 0 and below 1, from "1%", "0.5 %" or "0.01".
double parse_fraction(std::string_view text);

/// A part of a picture's side, from 0 to 45 %: "8%", "0.08", "0".
float parse_margin(std::string_view text);

/// Bytes, at least 1, from "2G", "500 MB", "1.5GiB", or a bare number: decimal units unless they have an i.
uint64_t parse_bytes(std::string_view text);

/// Three finite numbers: "1.5,0,-2".
std::array<float, 3> parse_point(std::string_view text);

/// Scene-linear Rec.709 from three numbers from 0 on, "0.2,0.2,0.2", or from sRGB "#ff8000", whose # may be
/// left out, as it begins a comment in shells.
std::array<float, 3> parse_color(std::string_view text);

/// "1280x720"; both at least 1 and at most 65536.
PixelSize parse_pixel_size(std::string_view text);

/// "640x360+10+20": width, height, then the column and row of the upper left pixel, from 0.
PixelRect parse_pixel_rect(std::string_view text);

/// "450 ms", "12.3 s", "4 m 05 s", "2 h 03 m".
std::string format_seconds(double seconds);

/// "950", "12.3 k", "4.56 M", "1.20 G": three digits, with the decimal prefix.
std::string format_count(double count);

/// "950 B", "12.3 kB", "4.56 MB": decimal units.
std::string format_bytes(double bytes);

}  // namespace vernier
