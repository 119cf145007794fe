#pragma once

#include <optional>
#include <span>
#include <string>

#include "apps/notice_log.h"
#include "integrators/render.h"
#include "scene/bounds.h"
#include "scene/description.h"

namespace vernier::apps {

/// The camera called or numbered `choice`; the first one when `choice` is empty; none when there are none to
/// choose from. An unnamed one is given its number as name. Throws Error(usage) listing the cameras there
/// are, and Error(input) when the one chosen has a defect; a notice tells of others that have.
std::optional<CameraDescription> choose_camera(std::span<const CameraDescription> cameras,
                                               const std::string& choice, NoticeLog& log);

/// A camera called "fitted" that sees all of `bounds` in a picture of the shape asked for, with a notice.
CameraDescription fit_camera(const Bounds& bounds, const RenderOptions& options, NoticeLog& log);

/// Fills in the size of the picture where none was asked for: the camera's shape, the longer side 1280
/// pixels, or 1024x1024 where it is square.
void fill_in_size(RenderOptions& options, const CameraDescription& camera);

}  // namespace vernier::apps
