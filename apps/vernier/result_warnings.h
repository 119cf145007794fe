// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_flags.h"
#include "apps/vernier/render_report.h"
#include "scene/scene.h"

namespace vernier::apps {

/// raycast's pictures are data; surroundings play no part in them.
inline bool shows_light(const RenderFlags& flags) { return flags.integrator != "raycast"; }

/// Says what is wrong with a picture, and what helps.
void warn_of_result(const RenderResult& result, const Scene& scene, const RenderFlags& flags,
                    const RenderReport& report, NoticeLog& log);

}  // namespace vernier::apps
