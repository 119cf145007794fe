// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>

#include "apps/vernier/render_options.h"

namespace vernier::apps {

/// Where a picture stands among those of a run.
struct PlaceInRun {
  size_t picture = 1, pictures = 1;  ///< counted from 1
  size_t rendered = 0;               ///< of those before it; others were there already
  double seconds = 0;                ///< since the run began

  /// Seconds until the last is done, when `fraction` of this one is; none when too little is done to say.
  std::optional<double> time_left(double fraction) const;
};

/// Adds to an event the error and its 95 % interval, where they are known.
void add_error(nlohmann::ordered_json& event, const ErrorEstimate& error);

/// Says on standard error how far a render is: a bar redrawn in place, a line now and then, or JSON lines.
class ProgressReporter {
 public:
  ProgressReporter(ProgressMode mode, const RenderSettings& options, const PlaceInRun& place);
  ~ProgressReporter() { finish(); }
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  void update(const RenderProgress& progress);
  /// Ends the bar's line.
  void finish();

 private:
  ProgressMode mode_;
  int spp_;
  PlaceInRun place_;      ///< as it was when this picture began
  double last_line_ = 0;  ///< seconds of rendering at the last line
  bool bar_drawn_ = false;
};

}  // namespace vernier::apps
