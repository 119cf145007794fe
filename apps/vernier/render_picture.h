// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "apps/vernier/posed_scene.h"
#include "apps/vernier/progress.h"

namespace vernier::apps {

/// What a picture needs to know of the run that it belongs to.
struct PictureContext {
  std::string command_line, picture_command;
  PlaceInRun place;
  std::atomic<bool>& write_now;
  std::optional<Moments> moments;  ///< none: no layer asks for them
};

struct PictureOutcome {
  ExitCode code = ExitCode::done;
  bool is_stopped = false;  ///< by a signal, which ends the run
};

/// Renders one picture, writes it and all that is told of it, and says so. The request has the flags of this
/// picture alone. Throws Error; outputs that cannot be written are told and make the exit code.
PictureOutcome render_picture(const RenderRequest& request, PosedScene& posed, const View& view,
                              const PictureContext& context, NoticeLog& log);

}  // namespace vernier::apps
