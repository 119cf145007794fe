// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "integrators/render/render_state.h"
#include "integrators/render/settings_identity.h"

// A render kept in a file. docs/resume.md describes its format.

namespace vernier {

/// Removes what is called `name` and returns its value; empty where there is none.
std::string take(RenderIdentity& identity, const std::string& name);

struct Checkpoint {
  RenderIdentity identity;
  std::shared_ptr<RenderState> state;
};

/// Replaces `path` at once and wholly. Throws Error(output).
void write_checkpoint(const std::string& path, const RenderIdentity& identity, const RenderState& state);

/// Throws Error(input) when the file is not a checkpoint of this version, or is damaged.
Checkpoint read_checkpoint(const std::string& path);

/// Throws Error(input) when the file does not begin as a checkpoint of this version does.
void require_checkpoint(const std::string& path);

/// What a file says of its render without being read further.
struct CheckpointSummary {
  double samples_per_pixel = 0;
  std::optional<double> rel_rmse;  ///< about; none: it has not been looked at
};
/// Throws Error(input) as require_checkpoint() does.
CheckpointSummary read_checkpoint_summary(const std::string& path);

/// Throws Error(input) that names what differs when `checkpoint`, read from `path`, is of another render than
/// `wanted`.
void require_same_render(const std::string& path, const RenderIdentity& checkpoint,
                         const RenderIdentity& wanted);

}  // namespace vernier
