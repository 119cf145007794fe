// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/denoise_task.h"

#include <chrono>

#include "integrators/render/layers.h"
#include "scene/camera.h"

namespace vernier::apps {
namespace {

LayeredImage picture_of(const NoisyRender& noisy, std::shared_mutex& scene_mutex) {
  const std::shared_lock lock(scene_mutex);
  const RenderSettings& settings = noisy.settings;
  const Camera camera(settings.camera, settings.width, settings.height);
  return with_layers(noisy.result, find_layers(noisy.layers), *noisy.scene, camera, settings);
}

}  // namespace

DenoiseTask::DenoiseTask(NoisyRender noisy, std::shared_mutex& scene_mutex)
    : samples_(noisy.samples),
      denoiser_(noisy.denoiser),
      result_(std::async(std::launch::async, [noisy = std::move(noisy), &scene_mutex] {
        return denoise(picture_of(noisy, scene_mutex), noisy.denoiser);
      })) {}

bool DenoiseTask::is_done() const {
  return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace vernier::apps
