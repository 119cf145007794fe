// SPDX-License-Identifier: Apache-2.0
#include "integrators/light_parts.h"

#include <fmt/format.h>

#include <set>

#include "core/base/names.h"
#include "scene/scene.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr std::string_view environment_name = "environment";
constexpr std::string_view rest_name = "rest";

constexpr std::array<std::string_view, light_way_count> way_names{
    "emission",        "background",          "diffuse_direct",        "diffuse_indirect", "glossy_direct",
    "glossy_indirect", "transmission_direct", "transmission_indirect", "volume_direct",    "volume_indirect"};

size_t find_way(const std::string& name) {
  const auto found = std::find(way_names.begin(), way_names.end(), name);
  if (found == way_names.end())
    throw_unknown_name("part of the light", name,
                       std::vector<std::string>(way_names.begin(), way_names.end()));
  return size_t(found - way_names.begin());
}

[[noreturn]] void refuse(const std::string& problem) {
  throw Error(ErrorKind::usage, {}, "light groups", problem);
}

/// Their names become those of channels.
void check_names(std::span<const LightGroup> groups) {
  if (groups.size() >= most_light_groups)
    refuse(fmt::format("there are {}; expected {} at most", groups.size(), most_light_groups - 1));
  std::set<std::string_view> names{rest_name};
  for (const LightGroup& group : groups) {
    const auto is_plain = [](char c) { return std::isalnum(uint8_t(c)) || c == '_' || c == '-'; };
    if (group.name.empty() || !std::all_of(group.name.begin(), group.name.end(), is_plain))
      refuse(fmt::format("a group called '{}'; expected letters, digits, _ and -: NAME=LIGHT", group.name));
    if (!names.insert(group.name).second) refuse(fmt::format("two groups are called '{}'", group.name));
  }
}

/// The first group that has one of these names among its lights; the last of all when none has.
uint8_t find_group(std::span<const LightGroup> groups, std::initializer_list<std::string_view> names) {
  const auto has_one = [&](const LightGroup& group) {
    return std::any_of(group.lights.begin(), group.lights.end(), [&](const std::string& light) {
      return std::find(names.begin(), names.end(), light) != names.end();
    });
  };
  return uint8_t(std::find_if(groups.begin(), groups.end(), has_one) - groups.begin());
}

/// All that lights are called by.
std::vector<std::string> light_names(const Scene& scene) {
  const SceneNames& names = scene.names();
  std::set<std::string> known(names.lamps().begin(), names.lamps().end());
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    const LightSource source = scene.lights()[i].source();
    if (source.kind != LightSource::Kind::instance) continue;
    known.insert(names.texts()[names.of(source.index).object]);
    known.insert(names.texts()[names.of(source.index).material]);
  }
  if (scene.has_environment()) known.emplace(environment_name);
  return {known.begin(), known.end()};
}

}  // namespace

std::span<const std::string_view> light_way_names() { return way_names; }

LightSorter::LightSorter(const LightSplit& split, const Scene& scene) {
  for (const std::string& way : split.ways) {
    ways_.push_back(find_way(way));
    layers_.push_back(way);
  }
  check_names(split.groups);
  if (split.groups.empty()) return;
  const std::vector<std::string> known = light_names(scene);
  for (const LightGroup& group : split.groups) {
    layers_.push_back("light_" + group.name);
    for (const std::string& light : group.lights)
      if (!std::binary_search(known.begin(), known.end(), light)) throw_unknown_name("light", light, known);
  }
  layers_.push_back("light_" + std::string(rest_name));
  const SceneNames& names = scene.names();
  for (uint32_t i = 0; i < names.instance_count(); ++i) {
    const SceneNames::Instance& instance = names.of(i);
    group_of_instance_.push_back(
        find_group(split.groups, {names.texts()[instance.object], names.texts()[instance.material]}));
  }
  for (const std::string& lamp : names.lamps()) group_of_lamp_.push_back(find_group(split.groups, {lamp}));
  group_of_environment_ = find_group(split.groups, {environment_name});
}

}  // namespace vernier
