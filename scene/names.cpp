// SPDX-License-Identifier: Apache-2.0
#include "scene/names.h"

#include <fmt/format.h>

#include <unordered_map>

namespace vernier {

SceneNames::SceneNames(const SceneDescription& description) {
  std::unordered_map<std::string, uint32_t> places;
  const auto place_of = [&](const std::string& name) {
    const auto [found, is_new] = places.try_emplace(name, uint32_t(texts_.size()));
    if (is_new) texts_.push_back(name);
    return found->second;
  };
  const auto named = [](const std::string& name, const char* kind, size_t number) {
    return name.empty() ? fmt::format("{} {}", kind, number) : name;
  };
  std::vector<uint32_t> materials;
  for (const auto& material : description.materials)
    materials.push_back(place_of(named(material.name, "material", materials.size() + 1)));
  for (const auto& instance : description.instances) {
    const size_t number = instance.object.value_or(uint32_t(instances_.size())) + size_t{1};
    const std::string object = named(instance.name, "object", number);
    instances_.push_back({place_of(object), materials[instance.material],
                          place_of(instance.asset.empty() ? object : instance.asset)});
  }
  for (const auto& lamp : description.lights) lamps_.push_back(named(lamp.name, "lamp", lamps_.size() + 1));
}

}  // namespace vernier
