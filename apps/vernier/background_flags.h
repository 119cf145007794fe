// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vernier/ground.h"
#include "vernier/settings.h"

namespace vernier::apps {

/// --transparent, --background and --ground, as typed.
struct BackgroundFlags {
  bool transparent = false;
  std::string background;  ///< colour or file; empty: not given
  std::string ground = "none";

  /// The file to be read for it, if any.
  std::string file() const;
};

/// Declares the flags on `command`.
void add_background_flags(CLI::App& command, BackgroundFlags& flags);

/// What they ask for, with a picture that is there, for outputs that can hold it. Throws Error.
Background choose_background(const BackgroundFlags& flags, const std::vector<std::string>& outputs);

/// Throws Error(input) unless the picture behind the scene, if there is to be one, can be decoded: before
/// anything else takes time, for it is read only when rendering begins.
void require_background(const BackgroundFlags& flags);

/// The ground asked for. Throws Error(usage) on a shadow with nothing behind it to fall on, or for an
/// integrator that casts none.
std::optional<GroundKind> choose_ground(const BackgroundFlags& flags, const std::string& integrator);

}  // namespace vernier::apps
