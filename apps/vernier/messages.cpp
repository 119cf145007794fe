// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/messages.h"

#include <fmt/format.h>

#include <cstdio>

namespace vernier::apps {

void print_error(std::string_view text) { fmt::print(stderr, "error: {}\n", one_line(text)); }

std::string describe(const Notice& notice) {
  const bool warning = notice.severity == Notice::Severity::warning;
  return one_line(fmt::format("{}: {}{}{}", warning ? "warning" : "note", notice.place,
                              notice.place.empty() ? "" : ": ", notice.text));
}

std::string shell_quoted(std::span<const char* const> words) {
  const std::string_view safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  std::string line;
  for (const std::string_view word : words) {
    if (!line.empty()) line += ' ';
    if (!word.empty() && word.find_first_not_of(safe) == std::string_view::npos) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

std::string shell_quoted(const std::vector<std::string>& words) {
  std::vector<const char*> pointers;
  pointers.reserve(words.size());
  for (const std::string& word : words) pointers.push_back(word.c_str());
  return shell_quoted(pointers);
}

}  // namespace vernier::apps
