// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/file_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/base/names.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

struct Entry {
  const char* word;
  Placeholder placeholder;
};
constexpr std::array<Entry, 4> words{{{"name", Placeholder::name},
                                      {"camera", Placeholder::camera},
                                      {"variant", Placeholder::variant},
                                      {"frame", Placeholder::frame}}};

/// A part of a file's name: not a path, not hidden, nothing that a terminal obeys.
std::string as_file_name(std::string text) {
  for (char& c : text)
    if (c == '/' || static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '_';
  if (text.starts_with('.')) text[0] = '_';
  return text.empty() ? "unnamed" : text;
}

}  // namespace

std::string text_of(Placeholder placeholder) {
  const auto entry =
      std::find_if(words.begin(), words.end(), [&](const Entry& e) { return e.placeholder == placeholder; });
  return fmt::format("{{{}}}", entry->word);
}

FilePattern::FilePattern(const std::string& text) : text_(text) {
  for (size_t at = 0; at < text_.size();) {
    const size_t special = std::min(text_.find_first_of("{#%", at), text_.size());
    if (special > at) parts_.push_back({text_.substr(at, special - at), std::nullopt});
    at = special;
    if (at == text_.size()) break;
    if (text_[at] == '%') refuse_printf(at);
    size_t end = at;
    if (text_[at] == '{') end = add_braces(at);
    if (text_[at] == '#') end = add_frame(at);
    if (end == at) parts_.push_back({std::string(1, text_[end++]), std::nullopt});
    at = end;
  }
}

/// Returns the end of the placeholder, or `begin` where the brace is but a brace.
size_t FilePattern::add_braces(size_t begin) {
  const size_t end = text_.find_first_of("{}/", begin + 1);
  if (end == std::string::npos || text_[end] != '}') return begin;
  const std::string word = text_.substr(begin + 1, end - begin - 1);
  std::vector<std::string> known;
  for (const Entry& entry : words) {
    if (word == entry.word) {
      parts_.push_back({{}, entry.placeholder});
      return end + 1;
    }
    known.push_back(text_of(entry.placeholder));
  }
  throw Error(ErrorKind::usage, text_, {},
              unknown_name_message("placeholder", fmt::format("{{{}}}", word), known));
}

/// A single # is but a character.
size_t FilePattern::add_frame(size_t begin) {
  const size_t end = std::min(text_.find_first_not_of('#', begin), text_.size());
  if (end - begin < 2) return begin;
  parts_.push_back({{}, Placeholder::frame, end - begin});
  return end;
}

void FilePattern::refuse_printf(size_t begin) const {
  const size_t end = text_.find_first_not_of("0123456789", begin + 1);
  if (end == std::string::npos || text_[end] != 'd') return;
  throw Error(ErrorKind::usage, text_, {},
              fmt::format("'{}' is no placeholder; #### or {{frame}} stands for the number of a frame",
                          text_.substr(begin, end + 1 - begin)));
}

bool FilePattern::has(Placeholder placeholder) const {
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const Part& part) { return part.placeholder == placeholder; });
}

bool FilePattern::names_folder() const {
  bool named = false;
  for (const Part& part : parts_) {
    named = named || part.placeholder;
    if (named && part.literal.find('/') != std::string::npos) return true;
  }
  return false;
}

std::string FilePattern::fill(const PictureName& picture) const {
  std::string filled;
  for (const Part& part : parts_) {
    if (!part.placeholder) {
      filled += part.literal;
    } else if (*part.placeholder == Placeholder::frame) {
      filled += fmt::format("{:0{}}", picture.frame.value_or(0), part.digits);
    } else {
      const std::string& text = *part.placeholder == Placeholder::name     ? picture.name
                                : *part.placeholder == Placeholder::camera ? picture.camera
                                                                           : picture.variant;
      filled += as_file_name(text);
    }
  }
  return filled;
}

std::string stem_of(const std::string& scene) {
  return scene == "-" ? "stdin" : std::filesystem::path(scene).stem().string();
}

}  // namespace vernier::apps
