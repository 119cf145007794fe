// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/path_rays.h"

#include <algorithm>
#include <cmath>

#include "apps/vernier/choose_camera.h"
#include "core/math/frame.h"
#include "core/sampling/sampler.h"
#include "core/sampling/warp.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace vernier::apps {
namespace {

constexpr int tile_size = 16;

void record_path(const Scene& scene, const Ray& primary, Sampler& sampler, int max_bounces, PathRays& rays) {
  rays.primary.push_back(primary);
  auto point = scene.intersect(primary);
  for (int bounce = 1; point; ++bounce) {
    sampler.start_block(static_cast<uint32_t>(bounce));
    const Vec2d light_point = sampler.next2_fine();
    const Vec2f direction = sampler.next2();
    const double light_choice = sampler.next1_fine();
    const Vec3f normal = point->front ? point->ng : -point->ng;
    const auto light = scene.sample_light(*point, light_choice, light_point);
    if (light && dot(light->wi, normal) > 0) rays.shadow.push_back(light->shadow);
    if (bounce > max_bounces) return;
    rays.bounce.push_back(
        point->spawn(Frame::from_normal(normal).to_world(sample_cosine_hemisphere(direction))));
    point = scene.intersect(rays.bounce.back());
  }
}

}  // namespace

PathRays record_path_rays(const Scene& scene, const CameraDescription& view, size_t paths, int max_bounces) {
  RenderSettings shape;
  fill_in_size(shape, view);
  const double shrink = std::sqrt(double(paths) / (double(shape.width) * shape.height));
  const int width = std::max(1, static_cast<int>(std::lround(shape.width * shrink)));
  const int height = std::max(1, static_cast<int>(std::lround(shape.height * shrink)));
  const Camera camera(view, width, height);
  PathRays rays;
  for (int tile_y = 0; tile_y < height; tile_y += tile_size)
    for (int tile_x = 0; tile_x < width; tile_x += tile_size)
      for (int y = tile_y; y < std::min(tile_y + tile_size, height); ++y)
        for (int x = tile_x; x < std::min(tile_x + tile_size, width); ++x) {
          Sampler sampler(static_cast<uint32_t>(y * width + x), 0, 0);
          sampler.start_block(0);
          const Vec2f jitter = sampler.next2();
          record_path(scene, camera.ray(Vec2f(float(x), float(y)) + jitter), sampler, max_bounces, rays);
        }
  return rays;
}

}  // namespace vernier::apps
