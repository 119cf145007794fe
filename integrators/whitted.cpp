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
                    const SampleContext&) const override {
    Walk walk{scene, sampler, {}, 0};
    ++walk.out.rays.camera;
    const Segment segment = camera_segment(scene, ray);
    const Rgb response = camera_response(scene, segment);
    const auto hit = intersect_from_camera(scene, segment);
    walk.out.met_surface = hit.has_value();
    walk.out.radiance =
        response * arriving(walk, segment, hit, {1, response, true, options_.background_apart});
    return walk.out;
  }

 private:
  /// Two to this power is how many rays one of the camera may become.
  static constexpr int deepest = 20;

  /// Lobes up to this width are followed as if they were perfect mirrors; wider ones show highlights only.
  static constexpr float sharp_alpha = 0.1f;

  struct Walk {
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
  };

  Rgb arriving(Walk& walk, const Segment& segment, const std::optional<Interaction>& hit,
               const Carried& carried) const {
    const Ray& ray = segment.ray;
    const Rgb passed =
        transmittance(walk.scene.volumes().stretch(segment.media, ray, 0, hit ? hit->t : ray.t_max));
    if (!hit && carried.sees_background) {
      walk.out.background += carried.weight * passed;
      return {0, 0, 0};
    }
    Rgb radiance(0, 0, 0);
    if (carried.sees_emitters) radiance = walk.scene.emitted(nullptr, ray, hit ? &*hit : nullptr).radiance;
    if (!hit || carried.depth >= options_.max_depth) return radiance * passed;
    const Shading surface = shade(walk.scene, *hit, -ray.direction);
    radiance += surface.albedo() * options_.ambient + direct(walk, *hit, surface, carried.weight * passed);

    const auto [rays, reflected] = surface.specular();
    if (rays.alpha <= sharp_alpha) {
      // A lobe of some width has shown the lights in direct() already.
      const bool is_smooth = rays.alpha < Ggx::smooth_limit;
      Carried next{carried.depth + 1, carried.weight * passed, is_smooth, false};
      radiance += follow(walk, *hit, reflected, rays.reflected, next);
      next.sees_background = carried.sees_background && is_smooth;
      radiance += follow(walk, *hit, rays.refracted, rays.transmitted, next);
    }
    return radiance * passed;
  }

  /// Light along a mirrored or refracted direction, if it can still matter.
  Rgb follow(Walk& walk, const Interaction& from, const Vec3f& direction, const Rgb& factor,
             Carried carried) const {
    carried.weight *= factor;
    if (max_component(carried.weight) < options_.cutoff) return {0, 0, 0};
    const Segment segment = from.spawn(direction);
    ++walk.out.rays.bounce;
    return factor * arriving(walk, segment, intersect(walk.scene, segment), carried);
  }

  /// `weight`: of what this returns in the final pixel.
  Rgb direct(Walk& walk, const Interaction& hit, const Shading& surface, const Rgb& weight) const {
    Rgb radiance(0, 0, 0);
    const LightSet& lights = walk.scene.lights();
    for (const Light* light : lights.delta_lights())
      if (const auto sample = light->sample(hit, {0, 0}))
        radiance += shine(walk, hit, surface, *sample, weight);
    walk.sampler.start_block(++walk.block);
    const Vec2d point = walk.sampler.next2_fine();
    const double choice = walk.sampler.next1_fine();
    const auto sample = walk.scene.sample_light(hit, choice, point);
    if (sample && !sample->is_delta) radiance += shine(walk, hit, surface, *sample, weight);
    return radiance;
  }

  static Rgb shine(Walk& walk, const Interaction& at, const Shading& surface, const LightSample& light,
                   const Rgb& weight) {
    const Rgb f_cos = surface.eval(light.wi).f_cos;
    if (is_black(f_cos)) return {0, 0, 0};
    ++walk.out.rays.shadow;
    const Passage passage = transmittance(walk.scene, at.spawn_to(light));
    const Rgb radiance = light.radiance * f_cos * passage.fraction / light.pdf;
    if (!passage.is_bent) return radiance;
    walk.out.missing.bent += weight * radiance;
    return {0, 0, 0};
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_whitted(const IntegratorOptions& options) {
  return std::make_unique<WhittedIntegrator>(options);
}

}  // namespace vernier
