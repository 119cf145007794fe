// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/vernier/render_memory.h"
#include "core/image/image_io.h"
#include "vernier/memory.h"
#include "vernier/settings.h"

namespace vernier::apps {

/// Of pictures around or behind a scene: what can be read within --max-memory (0: without), beside what the
/// process has.
ImageLimits limits_within(uint64_t max_memory);

/// What there is for textures: --max-memory, less what the largest of the pictures asked for takes.
MemoryLimit leaving_room_for_pictures(MemoryLimit limit, const RenderSettings& settings,
                                      const MemoryUse& use);

/// Whether the crop lies in the picture, and what a render of it takes in memory beside what the process has.
/// Throws Error(usage) or Error(memory).
void check_picture_size(const RenderSettings& options, const MemoryUse& use, const MemoryLimit& limit);

}  // namespace vernier::apps
