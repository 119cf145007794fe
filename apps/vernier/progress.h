// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/vernier/render_options.h"

namespace vernier::apps {

/// Says on standard error how far a render is: a bar redrawn in place, a line now and then, or JSON lines.
class ProgressReporter {
 public:
  ProgressReporter(ProgressMode mode, const RenderSettings& options);
  ~ProgressReporter() { finish(); }
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  void update(const RenderProgress& progress);
  /// Ends the bar's line.
  void finish();

 private:
  ProgressMode mode_;
  int spp_;
  double last_line_ = 0;  ///< seconds of rendering at the last line
  bool bar_drawn_ = false;
};

}  // namespace vernier::apps
