// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vernier/export.h"

namespace vernier {

/// "0.2.0"
VERNIER_API const char* version();

}  // namespace vernier
