// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/frame_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>
#include <set>

#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr int last_frame = 999'999;

/// The whole number that `text` begins with, which is cut off it.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || value < 0 || text.front() == '-') return std::nullopt;
  text.remove_prefix(size_t(end - text.data()));
  return value;
}

/// Cuts `word` off the beginning of `text`, if it is there.
bool take(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

struct Range {
  int first = 0, last = 0, step = 1;
};

[[noreturn]] void refuse(std::string_view text, const std::string& meant) {
  throw Error(ErrorKind::usage,
              fmt::format("'{}' is no frame; expected 7, 1-48, 1-48x2 or a list of such{}", text,
                          meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
}

Range parse_range(const std::string_view whole) {
  std::string_view text = whole;
  const auto first = take_number(text);
  if (!first) refuse(whole, "");
  if (text.empty()) return {*first, *first};
  // Other programs write 1..48 or 1:48.
  const bool foreign = take(text, "..") || take(text, ":");
  const bool dashed = !foreign && take(text, "-");
  const auto last = text.empty() ? std::nullopt : take_number(text);
  if (!last) refuse(whole, "");
  Range range{*first, *last};
  if (take(text, "x")) {
    const auto step = text.empty() ? std::nullopt : take_number(text);
    if (!step || *step == 0 || !text.empty()) refuse(whole, fmt::format("{}-{}x2", *first, *last));
    range.step = *step;
  }
  if (!dashed || !text.empty()) refuse(whole, fmt::format("{}-{}", *first, *last));
  if (range.last < range.first) refuse(whole, fmt::format("{}-{}", *last, *first));
  return range;
}

}  // namespace

std::vector<int> parse_frames(std::string_view text) {
  std::set<int> frames;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    const Range range = parse_range(text.substr(begin, end - begin));
    if (range.last > last_frame)
      throw Error(ErrorKind::usage, fmt::format("frame {} is beyond {}, the last", range.last, last_frame));
    for (int frame = range.first; frame <= range.last; frame += range.step) frames.insert(frame);
    begin = end + 1;
  }
  return {frames.begin(), frames.end()};
}

std::string frames_text(std::span<const int> frames) {
  if (frames.size() < 2) return fmt::format("{}", fmt::join(frames.begin(), frames.end(), ","));
  const int step = frames[1] - frames[0];
  for (size_t i = 1; i < frames.size(); ++i)
    if (frames[i] - frames[i - 1] != step)
      return fmt::format("{}", fmt::join(frames.begin(), frames.end(), ","));
  return fmt::format("{}-{}{}", frames.front(), frames.back(), step > 1 ? fmt::format("x{}", step) : "");
}

}  // namespace vernier::apps
