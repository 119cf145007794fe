// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/vernier/picture_command.h"
#include "apps/vernier/render_options.h"

namespace vernier::apps {

/// Flags of `vernier render` with their values, in place of those that `vernier serve` was given; an empty
/// value leaves a flag out. This is what a page can change, and all of it: the picture shown is that of the
/// command.
using FlagValues = std::map<std::string, std::string>;

/// What there is to choose from, for flags whose values are names. The empty one leaves the flag out.
using FlagChoices = std::map<std::string, std::vector<std::string>>;

/// Turns what pages ask for into a command of `vernier render`, and that into what is to be rendered.
class ViewFlags {
 public:
  /// `most_pixels` is the largest picture that may be asked for.
  ViewFlags(PictureCommand command, std::string scene, FlagChoices choices, int64_t most_pixels);

  const FlagChoices& choices() const { return choices_; }

  /// `now` with a change that a page sends: an object of flags and their values as texts, and "camera":
  /// "start" for that of the command, "fitted", or one of the scene's. Throws Error(usage) when it is none.
  FlagValues changed(const FlagValues& now, const nlohmann::json& change) const;

  /// For people, and for their shells.
  std::string command(const FlagValues& values) const;

  /// What the command asks for, but for surroundings, which are not read. Throws Error.
  RenderRequest request(const FlagValues& values) const;

 private:
  void set_camera(FlagValues& values, const std::string& choice) const;
  void set_flag(FlagValues& values, const std::string& flag, const std::string& value) const;
  void leave_out_dependents(FlagValues& values) const;
  std::string value_of(const FlagValues& values, const std::string& flag) const;

  const PictureCommand command_;
  const std::string scene_;
  const FlagChoices choices_;
  const int64_t most_pixels_;
};

}  // namespace vernier::apps
