// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "integrators/render/checkpoint.h"

namespace vernier::apps {

/// Declares --checkpoint and --resume on `command`.
void add_checkpoint_flags(CLI::App& command, RenderFlags& flags);

/// What they ask of one render.
class Checkpointing {
 public:
  /// Reads the checkpoint to resume from and sees that one can be written. Throws Error.
  Checkpointing(const RenderFlags& flags, NoticeLog& log);

  /// Hooks that go on from the checkpoint and write new ones. `report` and `camera` say what is being
  /// rendered. This object must outlive them. Throws Error(input) when the checkpoint is of another render.
  RenderHooks hooks(const RenderRequest& request, const RenderReport& report,
                    const CameraDescription& camera);

  /// Adds what docs/stats.md says of both.
  void add_to(nlohmann::ordered_json& stats) const;

  /// Throws Error(output) when the checkpoint could not be written at the end. Those on the way only warn,
  /// for a full disk may have room later and hours should not be lost to it.
  void require_written() const;

 private:
  void write(const RenderState& state);

  const RenderFlags& flags_;
  NoticeLog& log_;
  Checkpoint from_;
  RenderIdentity identity_;
  std::string failure_;  ///< of the last attempt; empty: it went well
  double seconds_ = 0;   ///< spent writing
  size_t written_ = 0;
  /// What was there to begin with.
  struct Resumed {
    uint64_t samples = 0;
    double seconds = 0, samples_per_pixel = 0;
  };
  std::optional<Resumed> resumed_;
};

}  // namespace vernier::apps
