// SPDX-License-Identifier: Apache-2.0
#include "core/base/names.h"

#include <algorithm>
#include <numeric>

#include "vernier/error.h"

namespace vernier {
namespace {

size_t levenshtein(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i + 1;
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t substitute = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substitute});
    }
  }
  return row[b.size()];
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

bool begins_with(std::string_view text, std::string_view prefix) {
  return text.size() >= prefix.size() && std::equal(prefix.begin(), prefix.end(), text.begin(),
                                                    [](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::string best;
  if (name.empty()) return best;
  size_t best_distance = std::max<size_t>(2, name.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    const size_t distance = levenshtein(name, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

std::string unknown_name_message(std::string_view kind, std::string_view name,
                                 std::span<const std::string> candidates) {
  std::string message = "unknown " + std::string(kind) + " '" + std::string(name) + "'";
  if (const auto nearest = nearest_name(name, candidates); !nearest.empty())
    message += "; did you mean '" + nearest + "'? There are: ";
  else
    message += "; there are: ";
  for (size_t i = 0; i < candidates.size(); ++i) message += (i ? ", " : "") + candidates[i];
  if (candidates.empty()) message += "none";
  return message;
}

void throw_unknown_name(std::string_view kind, std::string_view name,
                        std::span<const std::string> candidates) {
  throw Error(ErrorKind::usage, unknown_name_message(kind, name, candidates));
}

const std::string& find_by_prefix(std::string_view kind, std::string_view name,
                                  std::span<const std::string> candidates) {
  // What was typed in full, then with other capitals, then in part.
  if (const auto same = std::find(candidates.begin(), candidates.end(), name); same != candidates.end())
    return *same;
  std::vector<const std::string*> matches;
  std::string names;
  for (const auto& candidate : candidates) {
    if (!begins_with(candidate, name)) continue;
    if (candidate.size() == name.size()) return candidate;
    matches.push_back(&candidate);
    names += (names.empty() ? "" : ", ") + candidate;
  }
  if (name.empty() || matches.empty()) throw_unknown_name(kind, name, candidates);
  if (matches.size() > 1)
    throw Error(ErrorKind::usage, std::string(kind) + " '" + std::string(name) + "' may be any of " + names);
  return *matches.front();
}

}  // namespace vernier
