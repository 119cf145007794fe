// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/vernier/notice_log.h"
#include "apps/vernier/render_options.h"
#include "vernier/image.h"

// Measures error against a reference over rendering time and samples (`vernier bench convergence`).

namespace vernier::apps {

struct ConvergencePlan {
  /// Names, checked; of an accelerator, empty: what a scene takes by itself.
  std::vector<std::string> scenes, integrators, accelerators;
  std::vector<std::string> references;  ///< files, one a scene; empty: rendered
  int reference_spp = 0;
  std::vector<double> times;  ///< seconds of rendering, rising
  int seeds = 0;
  RenderFlags render;  ///< how the scenes are read and seen
};

/// Pictures of one integrator on one accelerator, all linear.
struct ConvergencePictures {
  std::string name;
  Image picture;  ///< after the longest time, first seed
  Image error;    ///< one channel: its relative error
};

struct SceneConvergence {
  nlohmann::ordered_json json;  ///< docs/bench.md, `scenes`
  Image reference;
  std::vector<ConvergencePictures> pictures;  ///< in the order of json["candidates"]
};

/// Runs of several candidates are interleaved, so that a machine that slows down slows all of them. Says on
/// standard error where it is.
SceneConvergence measure_convergence(const ConvergencePlan& plan, size_t scene, NoticeLog& log);

/// Square root of the mean over channels of (x - r)^2 / (r^2 + 0.01), a pixel.
Image relative_error_map(const Image& x, const Image& reference);

}  // namespace vernier::apps
