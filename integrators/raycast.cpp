// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <string>
#include <vector>

#include "core/base/names.h"
#include "integrators/integrator.h"
#include "scene/scene.h"

namespace vernier {
namespace {

/// A colour that tells numbers apart.
Rgb color_of(uint64_t number) {
  const uint32_t h = mix_bits(number + 1);
  return {float(h & 255) / 255, float((h >> 8) & 255) / 255, float((h >> 16) & 255) / 255};
}

using Output = Rgb (*)(const Scene&, const Ray&, const SurfacePoint&);

struct OutputEntry {
  std::string_view name;
  Output output;
};

constexpr std::array<OutputEntry, 7> outputs{{
    {"normal",  // shading normal toward the viewer, [-1,1] shown as [0,1]
     [](const Scene& scene, const Ray& ray, const SurfacePoint& hit) {
       return Rgb((scene.shade(hit, -ray.direction).normal() + Vec3f(1, 1, 1)) * 0.5f);
     }},
    {"albedo",  // fraction of light scattered toward the viewer
     [](const Scene& scene, const Ray& ray, const SurfacePoint& hit) {
       return scene.shade(hit, -ray.direction).albedo();
     }},
    {"depth",  // metres from the camera along the ray
     [](const Scene&, const Ray&, const SurfacePoint& hit) { return Rgb(hit.t, hit.t, hit.t); }},
    {"barycentric",  // weights of the triangle's three corners
     [](const Scene&, const Ray&, const SurfacePoint& hit) {
       return Rgb(std::max(0.f, 1 - hit.u - hit.v), hit.u, hit.v);
     }},
    {"id",  // a colour for each instance
     [](const Scene&, const Ray&, const SurfacePoint& hit) { return color_of(hit.instance); }},
    {"triangle",  // a colour for each triangle
     [](const Scene&, const Ray&, const SurfacePoint& hit) {
       return color_of((uint64_t(hit.instance) << 32) | hit.primitive);
     }},
    {"facing",  // green fronts, red backs, darker at grazing angles
     [](const Scene&, const Ray& ray, const SurfacePoint& hit) {
       const float cosine = std::abs(dot(ray.direction, hit.ng));
       return hit.front ? Rgb(0, cosine, 0) : Rgb(cosine, 0, 0);
     }},
}};

/// Primary hits only: what a ray meets, with no light. Black where it meets nothing; both sides of every
/// surface show.
class RaycastIntegrator : public Integrator {
 public:
  explicit RaycastIntegrator(const IntegratorOptions& options)
      : output_(find_by_name(outputs, "thing to show", options.show).output),
        background_apart_(options.background_apart) {}

  Estimate estimate(const Scene& scene, const Ray& ray, Sampler&,
                    const SampleContext& context) const override {
    Estimate out;
    ++out.rays.camera;
    auto hit = scene.intersect(ray);
    if (hit) hit->footprint = context.cone.width_at(hit->t);
    out.met_surface = hit.has_value();
    if (hit)
      out.radiance = output_(scene, ray, *hit);
    else if (background_apart_)
      out.background = {1, 1, 1};
    return out;
  }

 private:
  Output output_;
  bool background_apart_;
};

}  // namespace

std::unique_ptr<Integrator> make_raycast(const IntegratorOptions& options) {
  return std::make_unique<RaycastIntegrator>(options);
}

std::span<const std::string_view> raycast_outputs() {
  static const auto names = [] {
    std::array<std::string_view, outputs.size()> result;
    for (size_t i = 0; i < outputs.size(); ++i) result[i] = outputs[i].name;
    return result;
  }();
  return names;
}

}  // namespace vernier
