// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/visible_light.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "integrators/light_paths.h"
#include "integrators/render/first_hit.h"
#include "scene/camera.h"
#include "scene/segment.h"
#include "vernier/session.h"

namespace vernier {
namespace {

constexpr int grid = 24;              // pixels a side
constexpr int samples_per_pixel = 8;  // a power of two, for stratification
constexpr uint64_t seed = 0;
constexpr uint64_t light_paths_per_pixel = 16;  // the same
constexpr int light_path_block = 4;             // pixels a side, over which they are averaged
/// Of the radiance that a white environment of radiance 1 would make visible.
constexpr float faint = 0.01f;
/// Of a picture's mean luminance: what is darker is not lit.
constexpr double in_the_dark = 1e-3;

/// Sums over a pixel's samples that meet a surface.
struct PixelLight {
  int covered = 0;
  float scattered = 0, emitted = 0, albedo = 0;
};

void look(const Scene& scene, const Integrator& integrator, const Ray& ray, Sampler& sampler,
          PixelLight& pixel) {
  const auto hit = intersect_from_camera(scene, camera_segment(scene, ray));
  if (!hit) return;
  ++pixel.covered;
  const float emitted = luminance(scene.emitted(nullptr, ray, &*hit).radiance);
  const float total = luminance(integrator.estimate(scene, ray, sampler, {}).radiance);
  if (std::isfinite(total)) pixel.scattered += std::max(0.f, total - emitted);
  pixel.emitted += emitted;
  pixel.albedo += luminance(shade(scene, *hit, -ray.direction).albedo());
}

/// What light paths bring, if the integrator follows any, in the mean over the pixels of the grid around
/// each: they are too few for every pixel that they light to meet one.
std::vector<Rgb> light_of_paths(const Scene& scene, const Camera& camera, const Integrator& integrator,
                                int width, int height) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  const LightPathKind kind = integrator.light_paths(scene);
  std::vector<Rgb> pixels(size_t(grid) * grid, Rgb(0, 0, 0));
  if (kind == LightPathKind::none) return pixels;
  const LightPaths paths(scene, camera, settings, kind);
  constexpr uint64_t count = light_paths_per_pixel * grid * grid;
  Caught caught;
  for (uint64_t i = 0; i < count; ++i) paths.trace({i, 0}, caught);
  const float share = float(grid) / float(width) * float(grid) / float(height) / float(count);
  constexpr int blocks = grid / light_path_block;
  std::array<Rgb, size_t(blocks) * blocks> means{};
  means.fill(Rgb(0, 0, 0));
  for (const auto& [x, y, radiance, is_beyond] : caught.splats)
    if (!is_beyond)
      means[size_t(y * blocks / height) * blocks + size_t(x * blocks / width)] +=
          radiance * (share / square(float(light_path_block)));
  for (size_t i = 0; i < pixels.size(); ++i)
    pixels[i] = means[i / grid / light_path_block * blocks + i % grid / light_path_block];
  return pixels;
}

}  // namespace

VisibleLight visible_light(const Scene& scene, const Camera& camera, int width, int height) {
  const auto integrator = find_by_name(integrators(), "integrator", "path").make(IntegratorOptions{});
  const std::vector<Rgb> brought = light_of_paths(scene, camera, *integrator, width, height);
  std::vector<PixelLight> pixels(size_t(grid) * grid);
  parallel_for(pixels.size(), [&](size_t i) {
    for (uint32_t sample = 0; sample < samples_per_pixel; ++sample) {
      Sampler sampler(uint32_t(i), sample, seed);
      const auto column = i % grid, row = i / grid;
      const Vec2f at = (Vec2f(float(column), float(row)) + sampler.next2()) / float(grid);
      look(scene, *integrator, camera.ray({at.x * float(width), at.y * float(height)}), sampler, pixels[i]);
    }
    pixels[i].scattered += luminance(brought[i]) * float(pixels[i].covered);
  });
  int covered = 0, lit = 0, shown = 0;
  for (const PixelLight& pixel : pixels) {
    if (pixel.covered == 0) continue;
    ++covered;
    const bool is_lit = pixel.scattered > 0 && pixel.scattered >= faint * pixel.albedo;
    lit += is_lit;
    shown += is_lit || pixel.emitted >= faint * float(pixel.covered);
  }
  if (covered == 0) return {};
  return {float(lit) / float(covered), float(shown) / float(covered), !scene.lights().delta_lights().empty()};
}

PictureLight picture_light(const Film& film, const Scene& scene, const Camera& camera,
                           const RenderSettings& options) {
  constexpr int most_a_side = 64;
  const int stride = (std::max(film.width(), film.height()) + most_a_side - 1) / most_a_side;
  const FirstHits first_hits(scene, camera, options, film);
  std::vector<double> covered, all;
  for (int y = std::min(stride, film.height()) / 2; y < film.height(); y += stride)
    for (int x = std::min(stride, film.width()) / 2; x < film.width(); x += stride) {
      all.push_back(luminance(Rgb(Vec3f(film.pixel(x, y)))));
      if (first_hits.at_center(x, y)) covered.push_back(all.back());
    }
  std::vector<double>& looked_at = covered.empty() ? all : covered;
  if (looked_at.empty()) return {};
  PictureLight light;
  for (const double value : looked_at) light.mean += value / double(looked_at.size());
  std::erase_if(looked_at, [&](double value) { return !(value > in_the_dark * light.mean); });
  if (looked_at.empty()) return light;
  const auto middle = looked_at.begin() + std::ptrdiff_t(looked_at.size() / 2);
  std::nth_element(looked_at.begin(), middle, looked_at.end());
  light.typical = *middle;
  return light;
}

bool is_dark(const VisibleLight& light) {
  return light.lit < (light.has_lamps ? 0.1f : 1.0f / 3) && light.shown < 0.5f;
}

bool is_dark(const Scene& scene, const RenderSettings& settings) {
  if (scene.lights().size() == 0) return true;
  const Camera camera(settings.camera, settings.width, settings.height);
  return is_dark(visible_light(scene, camera, settings.width, settings.height));
}

}  // namespace vernier
