// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "apps/vernier/commands.h"
#include "vernier/scene.h"

namespace vernier::apps {

/// How long each picture is exposed, as typed.
struct ShutterFlags {
  std::string shutter;  ///< empty: not given, everything stands still
  std::string shape;    ///< empty: not given, a box
};

/// Declares --shutter on `command`.
void add_shutter_flag(CLI::App& command, ShutterFlags& flags);
/// Declares --shutter-shape.
void add_shutter_shape_flag(CLI::App& command, ShutterFlags& flags);

/// "0.5": a part of a frame, half of it before and half after the frame's time; "-0.01,0.02": from so many
/// seconds after that time to so many. None where none was given. Throws Error(usage).
std::optional<Shutter> shutter_of(const ShutterFlags& flags, double frame_seconds);

/// RenderSettings::row_exposure from "box", "rolling" or "rolling:0.25". Throws Error(usage).
float row_exposure_of(const ShutterFlags& flags);

}  // namespace vernier::apps
