#pragma once

#include <vector>

#include "scene/description.h"
#include "scene/import/document.h"

namespace vernier {

/// How each extension that the file uses, and each core feature worth a word, is honoured. Throws
/// Error(input) naming the first required extension that is not.
std::vector<FeatureUse> report_features(const Document& document);

}  // namespace vernier
