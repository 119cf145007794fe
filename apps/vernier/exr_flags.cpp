// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/exr_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "apps/vernier/flags.h"
#include "core/base/names.h"
#include "integrators/render/picture.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct Compression {
  std::string_view name;
  bool has_level, loses;
};
constexpr Compression compressions[] = {{"none", false, false}, {"rle", false, false}, {"zips", false, false},
                                        {"zip", false, false},  {"piz", false, false}, {"dwaa", true, true},
                                        {"dwab", true, true}};

/// "zip", "dwaa:45".
Compression parse_compression(std::string_view text) {
  const size_t colon = text.find(':');
  const Compression& found = find_by_name(compressions, "compression", std::string(text.substr(0, colon)));
  if (colon == std::string_view::npos) return found;
  float level = 0;
  const auto [end, problem] = std::from_chars(text.data() + colon + 1, text.data() + text.size(), level);
  if (!found.has_level || problem != std::errc() || end != text.data() + text.size() || !(level >= 0))
    throw Error(ErrorKind::usage,
                fmt::format("'{}': {}", text,
                            found.has_level ? "expected a level from 0 on after the colon, as in dwaa:45"
                                            : "this compression has no level"));
  return found;
}

}  // namespace

void add_exr_flags(CLI::App& command, ExrOptions& options) {
  command.add_flag("--multipart", options.multipart,
                   "a part for each layer of .exr files, so that programs read only those they want");
  command.add_flag("--half", options.half, "16-bit colour and alpha in .exr files; layers keep 32 bits");
  command
      .add_option(
          "--compression", options.compression,
          "of .exr files: none, rle, zips, zip, piz, or with loss dwaa, dwab, with a level as in dwaa:45")
      ->check(parsed_by(parse_compression))
      ->type_name("KIND")
      ->capture_default_str();
}

void check_exr_flags(const ExrOptions& options, const std::vector<std::string>& outputs, bool has_layers) {
  const bool is_asked = options.half || options.multipart || options.compression != ExrOptions().compression;
  if (is_asked && std::all_of(outputs.begin(), outputs.end(), is_display_file))
    throw Error(ErrorKind::usage, {},
                options.half        ? "--half"
                : options.multipart ? "--multipart"
                                    : "--compression",
                "is about .exr files; add -o FILE.exr or leave it out");
  if (has_layers && parse_compression(options.compression).loses)
    throw Error(ErrorKind::usage, {}, "--compression",
                "loses digits, and the layers of the .exr are for calculating with; use zip, zips or piz");
}

std::string half_warning(const ExrOptions& options, const LayeredImage& picture) {
  if (!options.half) return {};
  const Image color = picture.rgb();
  const auto count = std::count_if(color.values.begin(), color.values.end(),
                                   [](float value) { return std::abs(value) > largest_half; });
  if (count == 0) return {};
  return fmt::format(
      "{} values are above {}, the most that 16 bits hold, and are written as that; leave out --half", count,
      largest_half);
}

}  // namespace vernier::apps
