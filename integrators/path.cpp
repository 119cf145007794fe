#include "integrators/transport.h"
#include "scene/scene.h"

namespace vernier {
namespace {

/// Unidirectional path tracing with next-event estimation and multiple importance sampling (Kajiya 1986;
/// Veach 1997, chapters 9 and 10). Unbiased up to the depth limit.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorOptions& options) : options_(options) {}

  Estimate estimate(const Scene& scene, const Ray& camera_ray, Sampler& sampler) const override {
    Estimate out;
    Ray ray = camera_ray;
    Rgb throughput(1, 1, 1);
    Rgb absorption(0, 0, 0);   // of the volume the ray is in
    float radiance_scale = 1;  // product of eta^2: undoes the compression of radiance inside dense media
    Scattering last;           // how the ray came to be
    auto hit = scene.intersect_from_camera(ray);
    ++out.rays.camera;

    for (int depth = 1;; ++depth) {
      if (hit) throughput *= transmittance(absorption, hit->t);
      out.radiance += throughput * met_emission(scene, last, ray, hit);
      if (!hit || depth == options_.max_depth) break;

      sampler.start_block(uint32_t(depth));
      const Vec2d light_point = sampler.next2_fine();
      const Vec2f direction = sampler.next2();
      const double light_choice = sampler.next1_fine();
      const float lobe_choice = sampler.next1();
      const float roulette = sampler.next1();

      const Shading surface = scene.shade(*hit, -ray.direction, throughput);
      if (options_.light_sampling != LightSampling::bsdf) {
        const auto light = scene.sample_light(*hit, light_choice, light_point);
        const bool through = light && surface.is_transmitted(light->wi);
        const Rgb medium = through ? absorption_beyond(scene.material(*hit), hit->front) : absorption;
        out.radiance += throughput * direct(scene, surface, light, medium, out.rays);
      }
      const auto next = surface.sample(lobe_choice, direction);
      if (!next) break;
      throughput *= next->weight;
      radiance_scale *= next->eta * next->eta;
      if (next->is_transmitted) absorption = absorption_beyond(scene.material(*hit), hit->front);
      if (options_.russian_roulette && depth > 1) {
        const float survival = survival_probability(throughput * radiance_scale);
        if (roulette >= survival) break;
        throughput /= survival;
      }
      last = {*hit, next->pdf, next->is_delta};
      ray = hit->spawn(next->wi);
      hit = scene.intersect(ray);
      ++out.rays.bounce;
    }
    return out;
  }

 private:
  /// The surface and density that a ray left with; no surface: the camera.
  struct Scattering {
    std::optional<SurfacePoint> from;
    float pdf = 0;
    bool is_delta = true;
  };

  /// Emission met by a ray, weighted against next-event estimation: area lights and environment alike.
  Rgb met_emission(const Scene& scene, const Scattering& last, const Ray& ray,
                   const std::optional<SurfacePoint>& hit) const {
    const bool only_met = last.is_delta || options_.light_sampling == LightSampling::bsdf;
    const auto [radiance, light_pdf] =
        scene.emitted(only_met ? nullptr : &*last.from, ray, hit ? &*hit : nullptr);
    if (only_met || light_pdf == 0) return radiance;
    if (options_.light_sampling == LightSampling::light) return {0, 0, 0};
    return radiance * power_heuristic(last.pdf, light_pdf);
  }

  /// Next-event estimation: light from one sampled light, weighted against the BSDF's own sampling.
  Rgb direct(const Scene& scene, const Shading& surface, const std::optional<LightSample>& light,
             const Rgb& absorption, RayCounts& rays) const {
    if (!light) return {0, 0, 0};
    const BsdfEval scattered = surface.eval(light->wi);
    if (is_black(scattered.f_cos)) return {0, 0, 0};
    ++rays.shadow;
    if (scene.occluded(light->shadow)) return {0, 0, 0};
    const bool only_sampled = light->is_delta || options_.light_sampling == LightSampling::light;
    const float weight = only_sampled ? 1 : power_heuristic(light->pdf, scattered.pdf);
    const float distance = length(light->shadow.direction) * light->shadow.t_max;
    return light->radiance * scattered.f_cos * transmittance(absorption, distance) * (weight / light->pdf);
  }

  /// Russian roulette. Five times the throughput instead of the throughput itself: ending paths that still
  /// carry a fifth of their light costs more in variance than it saves in rays on measured scenes.
  static float survival_probability(const Rgb& throughput) {
    return std::min(1.f, 5 * max_component(throughput));
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_path(const IntegratorOptions& options) {
  return std::make_unique<PathIntegrator>(options);
}

}  // namespace vernier
