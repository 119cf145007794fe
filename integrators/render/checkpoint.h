// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "integrators/render/render_state.h"

// A render kept in a file. docs/resume.md describes its format.

namespace vernier {

/// What the samples of a render depend on, as names and values for people to read: "seed" "7"; each name
/// once. Two renders with equal ones may go on from each other.
using RenderIdentity = std::vector<std::pair<std::string, std::string>>;

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

/// Throws Error(input) that names what differs when `checkpoint`, read from `path`, is of another render than
/// `wanted`.
void require_same_render(const std::string& path, const RenderIdentity& checkpoint,
                         const RenderIdentity& wanted);

}  // namespace vernier
