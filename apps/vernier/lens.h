// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/vernier/notice_log.h"
#include "scene/scene.h"
#include "vernier/settings.h"

namespace vernier::apps {

/// The lens of a camera, as typed.
struct LensFlags {
  std::optional<float> fstop;
  std::string focus;            ///< empty: not given
  std::optional<float> sensor;  ///< millimetres
};

/// Declares the flags on `command`.
void add_lens_flags(CLI::App& command, LensFlags& flags);

/// A thin lens as photographers tell it. Metres.
struct Lens {
  float fstop = 0, focal_length = 0, focus_distance = 0;
};

/// "50 mm f/2.8, focused at 3.2 m".
std::string lens_text(const Lens& lens);
nlohmann::ordered_json to_json(const Lens& lens);

/// Gives the camera of `settings`, whose size must be known, the lens that was asked for, focused on what it
/// sees of the scene; none asked for: it stays a pinhole. Throws Error(usage).
std::optional<Lens> fit_lens(RenderSettings& settings, const LensFlags& flags, const Scene& scene,
                             NoticeLog& log);

}  // namespace vernier::apps
