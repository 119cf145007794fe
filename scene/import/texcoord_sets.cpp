// SPDX-License-Identifier: Apache-2.0
#include "scene/import/texcoord_sets.h"

#include <algorithm>
#include <vector>

#include "scene/import/materials.h"

namespace vernier {

TexcoordSets assign_texcoord_sets(MaterialDescription& material) {
  // Texture slots are visited by how much they matter, so what is beyond two sets matters least.
  std::vector<int> seen;
  for_each_texture(material, [&](const TextureUse& use) {
    if (use && std::find(seen.begin(), seen.end(), use.texcoord) == seen.end()) seen.push_back(use.texcoord);
  });
  TexcoordSets sets;
  sets.wanted = seen.size();
  if (seen.empty()) return sets;
  sets.substitute = seen[0];
  const auto end_of_kept = seen.begin() + ptrdiff_t(std::min<size_t>(seen.size(), 2));
  const std::vector<int> kept(seen.begin(), end_of_kept);
  const auto is_kept = [&](int set) { return std::find(kept.begin(), kept.end(), set) != kept.end(); };
  for (const int set : kept)
    if (set > 1) sets.of_slot[is_kept(sets.of_slot[0]) ? 1 : 0] = set;
  for_each_texture(material, [&](TextureUse& use) {
    if (!use) return;
    if (!is_kept(use.texcoord)) use.texcoord = sets.substitute;
    use.texcoord = use.texcoord == sets.of_slot[1] ? 1 : 0;
  });
  return sets;
}

}  // namespace vernier
