// SPDX-License-Identifier: Apache-2.0
#include "scene/import/texcoord_sets.h"

#include <algorithm>
#include <array>

#include "scene/import/materials.h"

namespace vernier {

std::vector<int> assign_texcoord_sets(MaterialDescription& material) {
  std::vector<int> sets{0, 1};
  std::array<bool, 2> is_taken{false, false};
  for_each_texture(material, [&](const TextureUse& use) {
    if (use && use.texcoord < 2) is_taken[size_t(use.texcoord)] = true;
  });
  for_each_texture(material, [&](const TextureUse& use) {
    if (!use || use.texcoord < 2 || std::find(sets.begin(), sets.end(), use.texcoord) != sets.end()) return;
    const auto free = std::find(is_taken.begin(), is_taken.end(), false);
    if (free == is_taken.end()) {
      sets.push_back(use.texcoord);
      return;
    }
    sets[size_t(free - is_taken.begin())] = use.texcoord;
    *free = true;
  });
  for_each_texture(material, [&](TextureUse& use) {
    if (use) use.texcoord = int(std::find(sets.begin(), sets.end(), use.texcoord) - sets.begin());
  });
  return sets;
}

}  // namespace vernier
