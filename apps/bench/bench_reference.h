// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/vernier/render_options.h"
#include "scene/scene.h"
#include "vernier/image.h"

// What benches that measure error compare with.

namespace vernier::apps {

struct Reference {
  Image picture;
  double rel_mse = 0;           ///< its own, as far as known
  Image standard_error;         ///< three channels; empty where a file has no layer `error`
  nlohmann::ordered_json json;  ///< docs/bench.md, `reference`
};

/// Benches count the seeds of their runs from 1 and stay below this.
constexpr uint64_t reference_seed = 1'000'001;

/// For runs that nothing interrupts.
extern const std::atomic<bool> never_stop;

Reference read_reference(const std::string& file);

/// Path traced, evenly sampled, with a seed of its own.
Reference render_reference(const Scene& scene, const Camera& camera, RenderSettings options, int spp,
                           int max_depth);

/// Width over height as asked for, else that of `reference` (may be null); 0: neither.
float bench_aspect(const RenderFlags& flags, const Image* reference);

/// Size as asked for, else that of `reference` (may be null), else small.
RenderSettings bench_options(const RenderFlags& flags, const CameraDescription& view, const Image* reference);

/// A scene in its surroundings, and how a bench renders it.
struct BenchScene {
  std::unique_ptr<Scene> scene;
  CameraDescription view;
  RenderSettings options;
};
/// Reads one as the flags say, of the size of `reference` (may be null) unless they say one. Says on standard
/// error what is worth saying. Throws Error.
BenchScene read_bench_scene(const RenderFlags& flags, const Image* reference);

/// Flags that say how the scene is seen: size, camera, depth, surroundings.
void add_measured_picture_flags(CLI::App& command, RenderFlags& flags);

}  // namespace vernier::apps
