// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
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

/// The picture behind the scene, for Background::picture; null where there is to be none. Throws
/// Error(input), also where it has no room within `max_memory` (0: without).
std::shared_ptr<const Image> read_background_picture(const BackgroundFlags& flags, uint64_t max_memory);

/// The ground asked for. Throws Error(usage) on a shadow with nothing behind it to fall on, or for an
/// integrator that casts none.
std::optional<GroundKind> choose_ground(const BackgroundFlags& flags, const std::string& integrator);

}  // namespace vernier::apps
