// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/vernier/camera_flags.h"
#include "apps/vernier/notice_log.h"
#include "integrators/render/render.h"
#include "scene/geometry.h"

namespace vernier::apps {

/// The scene's camera that the flags ask for: by name or number, else the first; none when there are none to
/// choose from, or when the flags say where to stand. An unnamed one is given its number as name. Throws
/// Error(usage) listing the cameras there are, and Error(input) when the one chosen has a defect; a notice
/// tells of others that have.
std::optional<CameraDescription> choose_camera(std::span<const CameraDescription> cameras,
                                               const CameraFlags& flags, NoticeLog& log);

/// One of several cameras of a scene.
struct LabelledCamera {
  std::optional<CameraDescription> camera;  ///< none: it is to be placed yet
  std::string label;                        ///< that no other has: its name, or else its number
};

/// All cameras of a scene but those with a defect, of which a notice tells. Throws Error(input) when there is
/// no other.
std::vector<LabelledCamera> all_cameras(std::span<const CameraDescription> cameras, NoticeLog& log);

/// The camera to render with: `chosen`, or without one a camera called "look-from" that stands where the
/// flags say, or one called "fitted" that sees the scene's subject whole, for a turntable however it is
/// turned; then turned, widened or zoomed as asked, or made a panorama. Its lens is for fit_lens() to add.
/// `aspect` is the picture's width over height; 0: not given. Throws Error(usage).
CameraDescription place_camera(const std::optional<CameraDescription>& chosen, const CameraFlags& flags,
                               const SceneGeometry& geometry, float aspect, NoticeLog& log);

/// Fills in the size of the picture where none was asked for: the camera's shape, the longer side 1280
/// pixels, or 1024x1024 where it is square.
void fill_in_size(RenderSettings& options, const CameraDescription& camera);

/// Width over height as --size gives it; 0 where it does not.
float asked_aspect(const std::string& size);

}  // namespace vernier::apps
