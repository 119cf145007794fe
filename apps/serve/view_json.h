// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "apps/serve/frame.h"
#include "apps/serve/live_scene.h"
#include "apps/serve/view_flags.h"

// What pages are told, as JSON. docs/serve.md has every field.

namespace vernier::apps {

/// What stays the same as long as the program runs: the scene's file and what there is to choose from.
nlohmann::ordered_json facts_json(const LiveScene& scene, const ViewFlags& flags, const std::string& file);

/// A view that has been begun.
nlohmann::ordered_json view_json(uint64_t number, const std::string& command, const RenderRequest& request,
                                 const RenderSettings& settings, const LiveScene& scene,
                                 const NoticeLog& log);

/// A pixel of the whole picture, of which the frame may be a coarser one.
nlohmann::ordered_json pixel_json(int x, int y, const Frame& frame, const LiveScene& scene);

}  // namespace vernier::apps
