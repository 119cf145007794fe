// SPDX-License-Identifier: Apache-2.0
#include "tests/support/documented_fields.h"

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/support/temporary_folder.h"

namespace vernier::test {
namespace {

/// Parts of the names between backticks.
std::set<std::string> documented(const std::string& text) {
  std::set<std::string> names;
  for (size_t begin = text.find('`'); begin != std::string::npos; begin = text.find('`', begin + 1)) {
    const size_t end = text.find('`', begin + 1);
    if (end == std::string::npos) break;
    std::istringstream span(text.substr(begin + 1, end - begin - 1));
    for (std::string part; std::getline(span, part, '.');)
      names.insert(part.ends_with("[]") ? part.substr(0, part.size() - 2) : part);
    begin = end;
  }
  return names;
}

void collect(const nlohmann::json& json, const std::vector<std::string>& free, std::set<std::string>& names) {
  if (json.is_array())
    for (const auto& element : json) collect(element, free, names);
  if (!json.is_object()) return;
  for (const auto& [name, value] : json.items()) {
    names.insert(name);
    if (std::find(free.begin(), free.end(), name) == free.end()) collect(value, free, names);
  }
}

}  // namespace

std::vector<std::string> undocumented_fields(const nlohmann::json& json, const std::string& page,
                                             const std::vector<std::string>& free) {
  const std::set<std::string> known = documented(read_file(std::string(VERNIER_SOURCE_DIR "/docs/") + page));
  std::set<std::string> names;
  collect(json, free, names);
  std::vector<std::string> missing;
  std::set_difference(names.begin(), names.end(), known.begin(), known.end(), std::back_inserter(missing));
  return missing;
}

}  // namespace vernier::test
