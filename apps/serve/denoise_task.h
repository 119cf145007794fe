// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <future>
#include <shared_mutex>

#include "apps/vernier/denoising.h"
#include "integrators/render/render.h"
#include "scene/scene.h"
#include "vernier/settings.h"

namespace vernier::apps {

/// What is to be denoised: a render as it stands, which goes on meanwhile.
struct NoisyRender {
  std::shared_ptr<const Scene> scene;
  RenderSettings settings;
  RenderResult result;
  const Denoiser& denoiser;
  std::string layers;  ///< that denoising wants
  double samples = 0;  ///< a pixel
};

/// Denoises on a thread of its own, so that a new view need not wait for it.
class DenoiseTask {
 public:
  /// `scene_mutex` is shared while the scene is looked at, and must outlive this, as must who changes it.
  DenoiseTask(NoisyRender noisy, std::shared_mutex& scene_mutex);

  bool is_done() const;
  double samples() const { return samples_; }
  const Denoiser& denoiser() const { return denoiser_; }
  /// What came of it; throws what it threw. Once.
  Denoised take() { return result_.get(); }

 private:
  const double samples_;
  const Denoiser& denoiser_;
  std::future<Denoised> result_;  ///< waits for it when it is destroyed
};

}  // namespace vernier::apps
