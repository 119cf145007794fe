// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_flags.h"
#include "core/base/file_lock.h"
#include "vernier/session.h"

namespace vernier::apps {

/// Declares --checkpoint and --resume on `command`.
void add_checkpoint_flags(CLI::App& command, RenderFlags& flags);

/// Throws Error(input) unless the checkpoint to resume from is there, or is the one that will be written.
void require_resumable(const RenderFlags& flags);

/// What they ask of one render.
class Checkpointing {
 public:
  /// Throws Error as require_resumable() does, and Error(output) while another process writes the checkpoint.
  Checkpointing(const RenderFlags& flags, NoticeLog& log);

  /// Lets `session` go on from the checkpoint and write new ones. Throws Error(input) when the checkpoint is
  /// of another render. This object must outlive the session's run.
  void attach(RenderSession& session);

  /// Adds what docs/stats.md says of both.
  void add_to(nlohmann::ordered_json& stats) const;

  /// Throws Error(output) when the checkpoint could not be written at the end. Those on the way only warn,
  /// for a full disk may have room later and hours should not be lost to it.
  void require_written() const;

  /// To be called when the picture is finished and written.
  void drop_if_asked() const;

 private:
  void write(const RenderSession& session);

  const RenderFlags& flags_;
  NoticeLog& log_;
  std::optional<FileLock> lock_;  ///< of the checkpoint to be written
  bool resumes_ = false;
  std::string failure_;  ///< of the last attempt; empty: it went well
  double seconds_ = 0;   ///< spent writing
  size_t written_ = 0;
  std::optional<RenderStatus> resumed_;  ///< what was there to begin with
};

}  // namespace vernier::apps
