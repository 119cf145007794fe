// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "vernier/scene.h"

namespace tinygltf {
class Model;
}

namespace vernier {

/// How an extension is honoured.
FeatureUse extension_use(const std::string& name);

/// How each extension that is known is honoured, by name.
std::vector<FeatureUse> known_extensions();

/// How each extension that the file uses, and each core feature worth a word, is honoured.
std::vector<FeatureUse> report_features(const tinygltf::Model& model);

/// Lamps are approximated beside volumes that bend light in a way that is found in part.
void note_bent_light(SceneDescription& scene);

/// "NAME is ignored: NOTE"
std::string describe(const FeatureUse& feature);

/// Warnings of extensions that are not honoured exactly. Core features are left out only where that is right
/// for this kind of rendering, which is information.
std::vector<Notice> feature_notices(const std::vector<FeatureUse>& features);

}  // namespace vernier
