// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "scene/import/document.h"
#include "vernier/scene.h"

namespace vernier {

/// The surroundings that the shown scene names by EXT_lights_image_based: the sharpest of its cube maps,
/// turned, as a latitude-longitude picture. Null: it names none. Appends fingerprints of the image files
/// read. Throws Error(input).
std::shared_ptr<const EnvironmentDescription> read_image_light(const Document& document,
                                                               std::vector<Notice>& notices,
                                                               std::vector<std::string>& fingerprints);

}  // namespace vernier
