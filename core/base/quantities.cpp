// SPDX-License-Identifier: Apache-2.0
#include "core/base/quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "vernier/error.h"
#include "vernier/image.h"

namespace vernier {
namespace {

constexpr int max_side = 65536;

/// Takes a number off the front of `text`; empty when there is none or it does not fit.
template <typename T>
std::optional<T> take_number(std::string_view& text) {
  T value{};
  // std::from_chars would read "-1", "inf" and "nan"
  if (text.empty() || !((text[0] >= '0' && text[0] <= '9') || text[0] == '.')) return {};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return {};
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return value;
}

bool take(std::string_view& text, char expected) {
  if (text.empty() || text[0] != expected) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<PixelSize> take_size(std::string_view& text) {
  const auto width = take_number<int>(text);
  if (!width || !take(text, 'x')) return {};
  const auto height = take_number<int>(text);
  if (!height || *width < 1 || *height < 1 || *width > max_side || *height > max_side) return {};
  return PixelSize{*width, *height};
}

double unit_seconds(char unit) {
  switch (unit) {
    case 's':
      return 1;
    case 'm':
      return 60;
    case 'h':
      return 3600;
    default:
      return 0;
  }
}

[[noreturn]] void refuse(std::string_view text, std::string_view expected) {
  throw Error(ErrorKind::usage, fmt::format("'{}' is not {}", text, expected));
}

std::string with_prefix(double value, std::string_view unit) {
  constexpr std::array<std::string_view, 6> prefixes{"", "k", "M", "G", "T", "P"};
  size_t prefix = 0;
  while (std::abs(value) >= 999.5 && prefix + 1 < prefixes.size()) {
    value /= 1000;
    ++prefix;
  }
  const int decimals = prefix == 0 || value >= 99.95 ? 0 : value >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f} {}{}", value, decimals, prefixes[prefix], unit);
}

}  // namespace

double parse_seconds(std::string_view text) {
  constexpr std::string_view expected =
      "a duration greater than zero such as 90s, 10m, 1.5h, 1h30m or 45 (seconds)";
  std::string_view rest = text;
  double total = 0;
  while (!rest.empty()) {
    const bool first = rest.size() == text.size();
    const auto number = take_number<double>(rest);
    if (!number) refuse(text, expected);
    const bool bare = first && rest.empty();
    const double scale = bare ? 1 : rest.empty() ? 0 : unit_seconds(rest[0]);
    if (scale == 0) refuse(text, expected);
    if (!bare) rest.remove_prefix(1);
    total += *number * scale;
  }
  if (!(total > 0) || !std::isfinite(total)) refuse(text, expected);
  return total;
}

double parse_fraction(std::string_view text) {
  constexpr std::string_view expected = "a part of the whole, above 0 and below 1, such as 1% or 0.01";
  std::string_view rest = text;
  const auto number = take_number<double>(rest);
  if (!number) refuse(text, expected);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  const double scale = rest == "%" ? 0.01 : 1;
  if (scale == 1 && !rest.empty()) refuse(text, expected);
  const double part = *number * scale;
  if (!(part > 0 && part < 1)) refuse(text, expected);
  return part;
}

uint64_t parse_bytes(std::string_view text) {
  constexpr std::string_view expected = "an amount of memory such as 2G, 500M, 1.5GiB or 3000000000 (bytes)";
  constexpr std::string_view prefixes = "kMGT";
  std::string_view rest = text;
  const auto number = take_number<double>(rest);
  if (!number) refuse(text, expected);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  double bytes = *number;
  const size_t power = rest.empty() ? prefixes.npos : prefixes.find(rest.front());
  if (power != prefixes.npos) {
    rest.remove_prefix(1);
    bytes *= std::pow(take(rest, 'i') ? 1024.0 : 1000.0, double(power + 1));
  }
  take(rest, 'B');
  constexpr double most = 1e18;
  if (!rest.empty() || !(bytes >= 1 && bytes <= most)) refuse(text, expected);
  return uint64_t(bytes);
}

float parse_margin(std::string_view text) {
  std::string_view rest = text;
  const auto number = take_number<double>(rest);
  const double part = number.value_or(1) * (take(rest, '%') ? 0.01 : 1);
  if (!rest.empty() || part > 0.45) refuse(text, "a part of the picture from 0 to 45 %, such as 8%");
  return float(part);
}

std::array<float, 3> parse_point(std::string_view text) {
  std::array<float, 3> point{};
  std::string_view rest = text;
  for (size_t i = 0; i < point.size(); ++i) {
    const bool negative = take(rest, '-');
    const auto number = take_number<float>(rest);
    const bool separated = i + 1 < point.size() ? take(rest, ',') : rest.empty();
    if (!number || !std::isfinite(*number) || !separated)
      refuse(text, "three numbers separated by commas, such as 1.5,0,-2");
    point[i] = negative ? -*number : *number;
  }
  return point;
}

std::array<float, 3> parse_color(std::string_view text) {
  std::string_view digits = text;
  take(digits, '#');
  uint32_t code = 0;
  const char* end = digits.data() + digits.size();
  const auto [stopped, status] = std::from_chars(digits.data(), end, code, 16);
  if (digits.size() == 6 && status == std::errc() && stopped == end) {
    const auto linear = [code](int shift) { return srgb_to_linear(float(code >> shift & 255) / 255); };
    return {linear(16), linear(8), linear(0)};
  }
  std::array<float, 3> color{};
  try {
    color = parse_point(text);
  } catch (const Error&) {
    color[0] = -1;
  }
  if (*std::min_element(color.begin(), color.end()) < 0)
    refuse(text, "a colour: sRGB such as '#ff8000', or scene-linear such as 0.2,0.2,0.2");
  return color;
}

PixelSize parse_pixel_size(std::string_view text) {
  std::string_view rest = text;
  const auto size = take_size(rest);
  if (!size || !rest.empty())
    refuse(text,
           fmt::format("a size of the form WIDTHxHEIGHT, each from 1 to {}, such as 1280x720", max_side));
  return *size;
}

PixelRect parse_pixel_rect(std::string_view text) {
  constexpr std::string_view expected =
      "a part of the picture of the form WIDTHxHEIGHT+X+Y in whole pixels, such as 640x360+10+20";
  std::string_view rest = text;
  const auto size = take_size(rest);
  if (!size || !take(rest, '+')) refuse(text, expected);
  const auto x = take_number<int>(rest);
  if (!x || !take(rest, '+')) refuse(text, expected);
  const auto y = take_number<int>(rest);
  if (!y || !rest.empty()) refuse(text, expected);
  return {*x, *y, size->width, size->height};
}

std::string format_seconds(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1000);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const long long whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{} m {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} m", whole / 3600, whole % 3600 / 60);
}

std::string format_count(double count) {
  std::string text = with_prefix(count, "");
  if (text.back() == ' ') text.pop_back();
  return text;
}

std::string format_bytes(double bytes) { return with_prefix(bytes, "B"); }

}  // namespace vernier
