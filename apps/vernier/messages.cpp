// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/messages.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

namespace vernier::apps {
namespace {

bool json_is_spoken = false;

struct Job {
  std::string place;
  size_t number, count;
};
std::optional<Job> job;  ///< that is spoken about

/// "jobs.txt: line 3: TEXT" of what is about a job.
std::string placed(std::string_view text) {
  if (!job) return std::string(text);
  return text.empty() ? job->place : fmt::format("{}: {}", job->place, text);
}

const char* name_of(Notice::Severity severity) {
  return severity == Notice::Severity::warning ? "warning" : "note";
}

}  // namespace

void speak_json(nlohmann::ordered_json started) {
  json_is_spoken = true;
  started.update({{"event", "started"}});
  print_event(started);
}

bool speaks_json() { return json_is_spoken; }

JobScope::JobScope(std::string place, size_t number, size_t count) {
  job = Job{std::move(place), number, count};
}

JobScope::~JobScope() { job.reset(); }

void print_event(const nlohmann::ordered_json& said) {
  if (!json_is_spoken) return;
  nlohmann::ordered_json event = said;
  if (job) event.update({{"job", job->number}, {"jobs", job->count}});
  // File names need not be UTF-8, which JSON is.
  fmt::print(stderr, "{}\n", event.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_error(std::string_view text) {
  if (json_is_spoken)
    print_event({{"event", "failed"}, {"text", one_line(text)}});
  else
    fmt::print(stderr, "error: {}\n", one_line(placed(text)));
}

void print_notice(const Notice& notice) {
  if (json_is_spoken)
    print_event({{"event", name_of(notice.severity)},
                 {"place", one_line(notice.place)},
                 {"text", one_line(notice.text)}});
  else
    fmt::print(stderr, "{}\n", describe({notice.severity, placed(notice.place), notice.text}));
}

std::string describe(const Notice& notice) {
  return one_line(fmt::format("{}: {}{}{}", name_of(notice.severity), notice.place,
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
