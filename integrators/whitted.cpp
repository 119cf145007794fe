#include <fmt/format.h>

#include "core/base/error.h"
#include "integrators/transport.h"
#include "scene/scene.h"

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

  Estimate estimate(const Scene& scene, const Ray& ray, Sampler& sampler) const override {
    Walk walk{scene, sampler, {}, 0};
    ++walk.out.rays.camera;
    const auto hit = scene.intersect_from_camera(ray);
    walk.out.radiance = arriving(walk, ray, hit, {1, {1, 1, 1}, {0, 0, 0}, true});
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
  struct Segment {
    int depth;
    Rgb weight;          ///< of what it finds in the final pixel
    Rgb absorption;      ///< of the volume it passes
    bool sees_emitters;  ///< false where direct lighting has counted them already
  };

  Rgb arriving(Walk& walk, const Ray& ray, const std::optional<SurfacePoint>& hit,
               const Segment& segment) const {
    Rgb radiance(0, 0, 0);
    if (segment.sees_emitters) radiance = walk.scene.emitted(nullptr, ray, hit ? &*hit : nullptr).radiance;
    if (!hit) return radiance;
    const Rgb passed = transmittance(segment.absorption, hit->t);
    if (segment.depth >= options_.max_depth) return radiance * passed;
    const Shading surface = walk.scene.shade(*hit, -ray.direction);
    radiance += surface.albedo() * options_.ambient + direct(walk, *hit, surface);

    const auto [rays, reflected] = surface.specular();
    if (rays.alpha <= sharp_alpha) {
      // A lobe of some width has shown the lights in direct() already.
      Segment next{segment.depth + 1, segment.weight * passed, segment.absorption,
                   rays.alpha < Ggx::smooth_limit};
      radiance += follow(walk, *hit, reflected, rays.reflected, next);
      next.absorption = absorption_beyond(walk.scene.material(*hit), hit->front);
      radiance += follow(walk, *hit, rays.refracted, rays.transmitted, next);
    }
    return radiance * passed;
  }

  /// Light along a mirrored or refracted direction, if it can still matter.
  Rgb follow(Walk& walk, const SurfacePoint& from, const Vec3f& direction, const Rgb& factor,
             Segment segment) const {
    segment.weight *= factor;
    if (max_component(segment.weight) < options_.cutoff) return {0, 0, 0};
    const Ray ray = from.spawn(direction);
    ++walk.out.rays.bounce;
    return factor * arriving(walk, ray, walk.scene.intersect(ray), segment);
  }

  Rgb direct(Walk& walk, const SurfacePoint& hit, const Shading& surface) const {
    Rgb radiance(0, 0, 0);
    const LightSet& lights = walk.scene.lights();
    for (const Light* light : lights.delta_lights())
      if (const auto sample = light->sample(hit, {0, 0})) radiance += shine(walk, surface, *sample);
    walk.sampler.start_block(++walk.block);
    const Vec2f point = walk.sampler.next2();
    const float choice = walk.sampler.next1();
    const auto sample = walk.scene.sample_light(hit, choice, point);
    if (sample && !sample->is_delta) radiance += shine(walk, surface, *sample);
    return radiance;
  }

  static Rgb shine(Walk& walk, const Shading& surface, const LightSample& light) {
    const Rgb f_cos = surface.eval(light.wi).f_cos;
    if (is_black(f_cos)) return {0, 0, 0};
    ++walk.out.rays.shadow;
    if (walk.scene.occluded(light.shadow)) return {0, 0, 0};
    return light.radiance * f_cos / light.pdf;
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_whitted(const IntegratorOptions& options) {
  return std::make_unique<WhittedIntegrator>(options);
}

}  // namespace vernier
