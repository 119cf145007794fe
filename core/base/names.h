// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vernier {

/// The candidate with the smallest Levenshtein distance to `name`; empty when none is near enough to suggest.
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

/// "unknown KIND 'NAME'; did you mean 'NEAREST'? There are: A, B, C", or "unknown KIND 'NAME'; there are:
/// ..."
std::string unknown_name_message(std::string_view kind, std::string_view name,
                                 std::span<const std::string> candidates);

/// Throws Error(usage) with unknown_name_message.
[[noreturn]] void throw_unknown_name(std::string_view kind, std::string_view name,
                                     std::span<const std::string> candidates);

/// The candidate that `name` is, or is the beginning of, without regard to case. Throws Error(usage), listing
/// what there is, when there is none or more than one.
const std::string& find_by_prefix(std::string_view kind, std::string_view name,
                                  std::span<const std::string> candidates);

/// The entry of a registry table called `name` (entries have a member `name`); throws Error(usage) listing
/// the names there are.
template <typename Table>
const auto& find_by_name(const Table& table, std::string_view kind, std::string_view name) {
  for (const auto& entry : table)
    if (entry.name == name) return entry;
  std::vector<std::string> names;
  names.reserve(std::size(table));
  for (const auto& entry : table) names.emplace_back(entry.name);
  throw_unknown_name(kind, name, names);
}

}  // namespace vernier
