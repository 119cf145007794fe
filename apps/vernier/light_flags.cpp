// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/light_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "vernier/error.h"

namespace vernier::apps {
namespace {

std::vector<std::string> split_at_commas(const std::string& list) {
  std::vector<std::string> parts;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    parts.push_back(list.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

LightGroup parse_group(const std::string& text) {
  const size_t equals = text.find('=');
  LightGroup group;
  if (equals != std::string::npos) {
    group = {text.substr(0, equals), split_at_commas(text.substr(equals + 1))};
  } else {
    group = {text, {text}};
    // The name becomes that of channels, in which a dot would part layer and channel.
    for (char& c : group.name)
      if (!std::isalnum(uint8_t(c)) && c != '-') c = '_';
  }
  if (group.name.empty() || std::count(group.lights.begin(), group.lights.end(), "") > 0)
    throw Error(ErrorKind::usage, {}, "--light-groups",
                fmt::format("'{}' is no group; expected NAME=LIGHT,LIGHT or a LIGHT", text));
  return group;
}

}  // namespace

void add_light_groups_flag(CLI::App& command, std::vector<std::string>& groups) {
  command
      .add_option("--light-groups", groups,
                  "a layer of the light of these alone, and one of the rest: names of lamps, of nodes or "
                  "materials that emit, or environment; may be given again")
      ->type_name("NAME=LIGHT,...")
      ->allow_extra_args(false);
}

LightSplit choose_light_split(const std::vector<std::string>& groups, const std::vector<Layer>& layers) {
  LightSplit split{light_ways_of(layers), {}};
  for (const std::string& group : groups) split.groups.push_back(parse_group(group));
  const bool has_layer = std::any_of(layers.begin(), layers.end(),
                                     [](const Layer& layer) { return layer.name == "light_groups"; });
  if (has_layer && groups.empty())
    throw Error(ErrorKind::usage, {}, "--aov", "light_groups are those of --light-groups, which is missing");
  return split;
}

}  // namespace vernier::apps
