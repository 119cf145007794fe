#pragma once

#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// How each extension that the file uses, and each core feature worth a word, is honoured. Throws
/// Error(input) naming the first required extension that is not.
std::vector<FeatureUse> report_features(const Document& document);

/// "NAME is ignored: NOTE"
std::string describe(const FeatureUse& feature);

/// Warnings of extensions that are not honoured exactly. Core features are left out only where that is right
/// for this kind of rendering, which is information.
std::vector<Notice> feature_notices(const std::vector<FeatureUse>& features);

}  // namespace vernier
