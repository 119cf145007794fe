// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "vernier/scene.h"

namespace vernier {

/// Bytes that building a scene takes beside its description, at the peak: an estimate, after what was
/// measured.
uint64_t bytes_to_build(const SceneDescription& scene);

}  // namespace vernier
