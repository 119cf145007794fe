// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/job_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr std::string_view spaces = " \t\r";

/// Takes the words of a line from its front.
class WordReader {
 public:
  explicit WordReader(std::string_view line) : rest_(line) {}

  /// None at the end or before a comment.
  std::optional<std::string> next() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(spaces), rest_.size()));
    if (rest_.empty() || rest_.front() == '#') return std::nullopt;
    std::string word;
    while (!rest_.empty() && spaces.find(rest_.front()) == std::string_view::npos) add_piece(word);
    return word;
  }

 private:
  void add_piece(std::string& word) {
    const char c = take();
    if (c == '\'' || c == '"') {
      add_quoted(word, c);
    } else if (c == '\\' && !rest_.empty()) {
      word += take();
    } else {
      word += c;
    }
  }

  /// Within double quotes a backslash is one, but before what has a meaning there.
  void add_quoted(std::string& word, char quote) {
    while (!rest_.empty()) {
      const char c = take();
      if (c == quote) return;
      const bool escapes = quote == '"' && c == '\\' && !rest_.empty() &&
                           std::string_view("\"\\$`").find(rest_.front()) != std::string_view::npos;
      word += escapes ? take() : c;
    }
    throw Error(ErrorKind::input, fmt::format("a {} is opened and not closed; write \\{} where the character "
                                              "itself is meant",
                                              quote, quote));
  }

  char take() {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    return c;
  }

  std::string_view rest_;
};

/// So that the command in a picture's header can be pasted.
void drop_command(std::vector<std::string>& words) {
  if (words.size() >= 2 && words[0] == "vernier" && words[1] == "render")
    words.erase(words.begin(), words.begin() + 2);
}

}  // namespace

std::vector<std::string> split_words(std::string_view line) {
  std::vector<std::string> words;
  WordReader reader(line);
  while (auto word = reader.next()) words.push_back(std::move(*word));
  return words;
}

std::vector<JobLine> read_job_list(std::istream& stream, const std::string& name) {
  std::vector<JobLine> jobs;
  std::string line, more;
  for (int number = 1; std::getline(stream, line); ++number) {
    JobLine job{number, {}};
    while (line.ends_with('\\') && std::getline(stream, more)) {
      line.back() = ' ';
      line += more;
      ++number;
    }
    try {
      job.words = split_words(line);
    } catch (const Error& error) {
      throw Error(error.kind(), name, place_of(job), error.what());
    }
    drop_command(job.words);
    if (!job.words.empty()) jobs.push_back(std::move(job));
  }
  if (stream.bad()) throw Error(ErrorKind::input, name, {}, "cannot be read to its end");
  return jobs;
}

std::string place_of(const JobLine& line) { return fmt::format("line {}", line.number); }

}  // namespace vernier::apps
