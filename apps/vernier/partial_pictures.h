// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "apps/vernier/render_report.h"
#include "vernier/session.h"

namespace vernier::apps {

/// Puts the picture so far into the files of a render that goes on.
class PartialPictures {
 public:
  /// All must outlive the session's run.
  PartialPictures(const RenderRequest& request, const RenderReport& report, NoticeLog& log)
      : request_(request), report_(report), log_(log) {}

  /// Lets `session` write now and then, if that is asked for, and when `now` becomes true.
  void attach(RenderSession& session, std::atomic<bool>& now);

 private:
  void write(const RenderSession& session);

  const RenderRequest& request_;
  const RenderReport& report_;
  NoticeLog& log_;
};

}  // namespace vernier::apps
