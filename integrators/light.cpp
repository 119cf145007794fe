// SPDX-License-Identifier: Apache-2.0
#include "integrators/transport.h"

namespace vernier {
namespace {

/// Light tracing: all light comes by paths that begin at lights (LightPathKind::all), but for what the camera
/// sees of the lights themselves. What it sees in mirrors and through surfaces that bend light stays black,
/// for no such path is led there.
class LightIntegrator : public Integrator {
 public:
  explicit LightIntegrator(const IntegratorOptions& options) : options_(options) {}

  Estimate estimate(const Scene& scene, const Ray& camera_ray, Sampler& /*sampler*/,
                    const SampleContext& /*context*/) const override {
    Estimate out;
    Segment segment = camera_segment(scene, camera_ray);
    Rgb throughput = camera_response(scene, segment);
    auto hit = intersect_from_camera(scene, segment);
    ++out.rays.camera;
    out.met_surface = hit.has_value();
    for (int depth = 1; depth <= options_.max_depth; ++depth) {
      throughput *= transmittance(
          scene.volumes().stretch(segment.media, segment.ray, 0, hit ? hit->t : segment.ray.t_max));
      if (!hit && options_.background_apart) {
        out.background = throughput;
        break;
      }
      out.radiance += throughput * scene.emitted(nullptr, segment.ray, hit ? &*hit : nullptr).radiance;
      if (!hit) break;
      throughput *= shade(scene, *hit, -segment.ray.direction).straight();
      if (is_black(throughput)) break;
      segment = hit->spawn(segment.ray.direction);
      hit = intersect(scene, segment);
      ++out.rays.bounce;
    }
    return out;
  }

  LightPathKind light_paths(const Scene& /*scene*/) const override { return LightPathKind::all; }

 private:
  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_light(const IntegratorOptions& options) {
  return std::make_unique<LightIntegrator>(options);
}

}  // namespace vernier
