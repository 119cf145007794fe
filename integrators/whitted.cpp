// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "integrators/transport.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// Recursive ray tracing: direct light, constant ambient, mirror reflection and refraction with Fresnel and
/// Beer-Lambert absorption (Whitted 1980, "An Improved Illumination Model for Shaded Display"). Every
/// punctual light is evaluated; of area lights and the environment one is sampled.
class WhittedIntegrator : public Integrator {
 public:
  explicit WhittedIntegrator(const IntegratorOptions& options) : options_(options) {
    if (options.max_depth > deepest)
      throw Error(ErrorKind::usage, {}, "--max-depth",
                  fmt::format("whitted follows at most {} path vertices, for at each one ray may become two; "
                              "use --integrator path",
                              deepest));
  }

  Estimate estimate(const Scene& scene, const Ray& ray, Sampler& sampler,
                    const SampleContext& sample) const override {
    TraceContext context{scene, sampler, {}, 0};
    ++context.out.rays.camera;
    const Segment segment = camera_segment(scene, ray);
    const Rgb response = camera_response(scene, segment);
    auto hit = intersect_from_camera(scene, segment);
    if (hit) hit->footprint = sample.cone.width_at(hit->t);
    context.out.met_surface = hit.has_value();
    context.out.radiance =
        response *
        incident_radiance(context, segment, hit, {1, response, true, options_.background_apart, sample.cone});
    return context.out;
  }

 private:
  /// Two to this power is how many rays one of the camera may become.
  static constexpr int deepest = 20;

  /// Lobes up to this width are followed as if they were perfect mirrors; wider ones show highlights only.
  static constexpr float sharp_alpha = 0.1f;

  struct TraceContext {
    const Scene& scene;
    Sampler& sampler;
    Estimate out;
    uint32_t block;  ///< of the sampler, a fresh one at each surface
  };

  /// What a ray carries on its way from the eye.
  struct Carried {
    int depth;
    Rgb weight;            ///< of what it finds in the final pixel
    bool sees_emitters;    ///< false where direct lighting has counted them already
    bool sees_background;  ///< where it leaves the scene, it is the background that shows
    RayCone cone;          ///< that it stands for
  };

  Rgb incident_radiance(TraceContext& context, const Segment& segment, const std::optional<Interaction>& hit,
                        const Carried& carried) const {
    const Ray& ray = segment.ray;
    const Rgb passed =
        transmittance(context.scene.volumes().stretch(segment.media, ray, 0, hit ? hit->t : ray.t_max));
    if (!hit && carried.sees_background) {
      context.out.background += carried.weight * passed;
      return {0, 0, 0};
    }
    Rgb radiance(0, 0, 0);
    if (carried.sees_emitters) radiance = context.scene.emitted(nullptr, ray, hit ? &*hit : nullptr).radiance;
    if (!hit || carried.depth >= options_.max_depth) return radiance * passed;
    const Shading surface = shade(context.scene, *hit, -ray.direction);
    radiance += surface.albedo() * options_.ambient + direct(context, *hit, surface, carried.weight * passed);

    const auto [rays, reflected] = surface.specular();
    if (rays.alpha <= sharp_alpha) {
      // A lobe of some width has shown the lights in direct() already.
      const bool is_smooth = rays.alpha < Ggx::smooth_limit;
      Carried next{carried.depth + 1,
                   carried.weight * passed,
                   is_smooth,
                   false,
                   {hit->footprint, carried.cone.spread}};
      radiance += trace_specular(context, *hit, reflected, rays.reflected, next);
      next.sees_background = carried.sees_background && is_smooth;
      radiance += trace_specular(context, *hit, rays.refracted, rays.transmitted, next);
    }
    return radiance * passed;
  }

  /// Light along a mirrored or refracted direction, if it can still matter.
  Rgb trace_specular(TraceContext& context, const Interaction& from, const Vec3f& direction,
                     const Rgb& factor, Carried carried) const {
    carried.weight *= factor;
    if (max_component(carried.weight) < options_.cutoff) return {0, 0, 0};
    const Segment segment = from.spawn(direction);
    auto hit = intersect(context.scene, segment);
    if (hit) hit->footprint = carried.cone.width_at(hit->t);
    ++context.out.rays.bounce;
    return factor * incident_radiance(context, segment, hit, carried);
  }

  /// `weight`: of what this returns in the final pixel.
  Rgb direct(TraceContext& context, const Interaction& hit, const Shading& surface, const Rgb& weight) const {
    Rgb radiance(0, 0, 0);
    const LightSet& lights = context.scene.lights();
    for (const Light* light : lights.delta_lights())
      if (const auto sample = light->sample(hit, {0, 0}))
        radiance += light_contribution(context, hit, surface, *sample, weight);
    context.sampler.start_block(++context.block);
    const Vec2d point = context.sampler.next2_fine();
    const double choice = context.sampler.next1_fine();
    const auto sample = context.scene.sample_light(hit, choice, point);
    if (sample && !sample->is_delta) radiance += light_contribution(context, hit, surface, *sample, weight);
    return radiance;
  }

  static Rgb light_contribution(TraceContext& context, const Interaction& at, const Shading& surface,
                                const LightSample& light, const Rgb& weight) {
    const Rgb f_cos = surface.eval(light.wi).f_cos;
    if (is_black(f_cos)) return {0, 0, 0};
    ++context.out.rays.shadow;
    const Passage passage = transmittance(context.scene, at.spawn_to(light));
    const Rgb radiance = light.radiance * f_cos * passage.fraction / light.pdf;
    if (!passage.is_bent) return radiance;
    context.out.missing.bent += weight * radiance;
    return {0, 0, 0};
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_whitted(const IntegratorOptions& options) {
  return std::make_unique<WhittedIntegrator>(options);
}

}  // namespace vernier
