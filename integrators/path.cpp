// SPDX-License-Identifier: Apache-2.0
#include "integrators/manifold.h"
#include "integrators/scattering_stretch.h"
#include "integrators/small_lamps.h"

namespace vernier {
namespace {

/// Unidirectional path tracing with next-event estimation and multiple importance sampling (Kajiya 1986;
/// Veach 1997, chapters 9 and 10). Unbiased but for what Estimate::missing tells.
///
/// A surface that a path passes straight on hides no light from the vertex before it: next-event estimation
/// looks through, and what the path meets beyond is weighted as if that vertex saw it. A point where a medium
/// scatters light is a vertex like any other, but for the depth, which counts surfaces.
///
/// Light of lamps that is scattered first by a sharp lobe is left to LightPathKind::caustics, and to
/// SpecularChains where the camera sees that by sharp lobes alone.
class PathIntegrator : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorOptions& options) : options_(options) {}

  Estimate estimate(const Scene& scene, const Ray& camera_ray, Sampler& sampler,
                    const SampleContext& context) const override {
    Estimate out;
    Segment segment = camera_segment(scene, camera_ray);
    Rgb throughput = camera_response(scene, segment);
    float eta_scale = 1;    // product of eta^2: undoes the compression of radiance inside dense media
    float audit_scale = 1;  // of the few paths that go on beyond the depth limit
    Scattering last;        // how the ray came to be
    LightRoute route;       // on which light comes to the camera; kept where parts are asked for
    SharpView view;         // whether light paths can end where the camera looks
    bool looks_through = options_.background_apart;  // the camera sees along it, through clear surfaces
    RayCone cone = context.cone;                     // what of the picture the ray stands for
    auto hit = intersect_from_camera(scene, segment);
    if (hit) hit->footprint = cone.width_at(hit->t);
    ++out.rays.camera;

    for (int vertex = 1, depth = 1;; ++vertex) {  // depth: of light that the ray meets
      const Stretch stretch =
          scene.volumes().stretch(segment.media, segment.ray, 0, hit ? hit->t : segment.ray.t_max);
      if (stretch.medium.scatters()) {
        sampler.start_block(medium_blocks + uint32_t(vertex));
        throughput *=
            scatter(out, {{scene, throughput, depth, route, view}, segment, stretch}, hit, context, sampler);
      } else {
        throughput *= transmittance(stretch);
      }
      if (vertex == 1) out.met_surface = hit.has_value();
      if (!hit && looks_through) {
        if (depth <= options_.max_depth) out.background = throughput;
        break;
      }
      const bool in_medium = hit && hit->is_in_medium();
      if (!in_medium && !(vertex == 1 && is_brought(context, hit)))
        add(out, depth, throughput * emission_with_mis(scene, last, segment.ray, hit),
            {context, route, source_of(hit)});
      if (!hit) break;

      sampler.start_block(uint32_t(vertex));
      const Vec2d light_point = sampler.next2_fine();
      const Vec2f direction = sampler.next2();
      const double light_choice = sampler.next1_fine();
      const float lobe_choice = sampler.next1();
      float roulette = sampler.next1();
      const float shadow_roulette = sampler.next1();

      if (looks_through && depth <= options_.max_depth && scene.catches_shadow(*hit)) {
        out.background = throughput * unshadowed(out, scene, *hit, light_choice, light_point);
        out.met_surface = depth > 1 || out.background != throughput;
        break;
      }
      if (depth == options_.max_depth && !in_medium) {
        if (roulette >= audited_share) break;
        roulette /= audited_share;
        audit_scale = 1 / audited_share;
        throughput *= audit_scale;
      }
      if (!in_medium) ++depth;
      const Shading surface = shade(scene, *hit, -segment.ray.direction, throughput);
      looks_through = looks_through && is_clear(surface);
      if (options_.light_sampling != LightSampling::bsdf && !in_medium)
        if (const auto light = scene.sample_light(*hit, light_choice, light_point);
            light && !(looks_through && will_be_met(*light, surface)))
          add_direct(out, {{scene, throughput, depth, route, view}, *hit, surface}, *light, context,
                     shadow_roulette);
      if (context.chains && view.is_sharp && options_.light_sampling != LightSampling::bsdf)
        add_chain(out, {{scene, throughput, depth, route, view}, *hit, surface}, vertex, context, sampler);
      const auto next = surface.sample(lobe_choice, direction);
      if (!next) break;
      if (context.sorter) route = route.scattered(surface, next->wi, next->is_delta, next->is_straight);
      throughput *= next->weight;
      eta_scale *= next->eta * next->eta;
      const float survival =
          survival_probability(options_, vertex, depth, throughput * (eta_scale / audit_scale));
      if (roulette >= survival) break;
      throughput /= survival;
      looks_through = looks_through && next->is_transmitted;
      if (!next->is_straight) {
        last = {*hit, next->pdf, next->is_delta || looks_through};
        view.scatter(next->is_delta);
      }
      looks_through = looks_through && !next->is_diffuse;
      cone = next->is_delta || next->is_straight ? RayCone{hit->footprint, cone.spread} : RayCone{};
      segment = hit->spawn(next->wi);
      hit = intersect(scene, segment);
      if (hit) hit->footprint = cone.width_at(hit->t);
      ++out.rays.bounce;
    }
    return out;
  }

  bool leaves_small_lamps() const override { return true; }
  LightPathKind light_paths(const Scene& scene) const override {
    return follows_caustics(options_, scene) ? LightPathKind::caustics : LightPathKind::none;
  }

 private:
  /// The surface and density that a ray left with; no surface: the camera.
  struct Scattering {
    std::optional<SurfacePoint> from;
    float pdf = 0;
    bool is_delta = true;
  };

  /// What a path carries.
  struct Carried {
    const Scene& scene;
    Rgb throughput;
    int depth;  ///< of light that it meets
    const LightRoute& route;
    const SharpView& view;
  };

  /// Where a path may be lit.
  struct Vertex {
    Carried path;
    const Interaction& at;
    const Shading& surface;
  };

  /// A path on its way between vertices.
  struct Way {
    Carried path;
    const Segment& segment;
    const Stretch& stretch;
  };

  /// How light came, for who keeps it apart.
  struct Origin {
    const SampleContext& context;
    const LightRoute& route;
    LightSource source;
  };
  static LightSource source_of(const std::optional<Interaction>& hit) {
    return hit ? LightSource{LightSource::Kind::instance, hit->instance} : LightSource{};
  }

  /// Light of a path of `depth` vertices after the camera, its source included.
  void add(Estimate& out, int depth, const Rgb& radiance, const Origin& origin) const {
    (depth <= options_.max_depth ? out.radiance : out.missing.depth) += radiance;
    if (const auto& to = origin.context; to.sorter && depth <= options_.max_depth)
      to.sorter->add(*to.parts, radiance, origin.route, origin.source);
  }

  /// Whether light paths bring what the camera sees of a surface's own light.
  static bool is_brought(const SampleContext& context, const std::optional<Interaction>& hit) {
    return context.small_lamps && hit && context.small_lamps->contains(*hit);
  }

  /// Emission met by a ray, weighted against next-event estimation: area lights and environment alike.
  Rgb emission_with_mis(const Scene& scene, const Scattering& last, const Ray& ray,
                        const std::optional<Interaction>& hit) const {
    const bool skip_mis = last.is_delta || options_.light_sampling == LightSampling::bsdf;
    const auto [radiance, light_pdf] =
        scene.emitted(skip_mis ? nullptr : &*last.from, ray, hit ? &*hit : nullptr);
    if (skip_mis || light_pdf == 0) return radiance;
    if (options_.light_sampling == LightSampling::light) return {0, 0, 0};
    return radiance * power_heuristic(last.pdf, light_pdf);
  }

  /// Whether a surface lets through some light that it does not scatter all around.
  static bool is_clear(const Shading& surface) { return !is_black(surface.specular().rays.transmitted); }
  /// Whether a light is left to the ray that passes a clear surface: behind rough ones too, what the camera
  /// sees is either surface or background, and only that ray can tell.
  static bool will_be_met(const LightSample& light, const Shading& surface) {
    return !light.is_delta && surface.is_transmitted(light.wi);
  }

  /// Part of the light from above that gets to a surface that catches shadows. What bends light dims it
  /// here as if it did not.
  Rgb unshadowed(Estimate& out, const Scene& scene, const Interaction& at, double light_choice,
                 const Vec2d& light_point) const {
    const auto light = scene.sample_ground_light(at, light_choice, light_point);
    if (!light) return {1, 1, 1};
    ++out.rays.shadow;
    return transmittance(scene, at.spawn_to(*light)).fraction;
  }

  /// Next-event estimation: light from one sampled light, weighted against the BSDF's own sampling.
  [[gnu::always_inline]] void add_direct(Estimate& out, const Vertex& vertex, const LightSample& light,
                                         const SampleContext& context, float roulette) const {
    const BsdfEval scattered = vertex.surface.eval(light.wi);
    if (is_black(scattered.f_cos)) return;
    const bool only_sampled = light.is_delta || options_.light_sampling == LightSampling::light;
    const float weight = only_sampled ? 1 : power_heuristic(light.pdf, scattered.pdf);
    Rgb radiance = vertex.path.throughput * light.radiance * scattered.f_cos * (weight / light.pdf);
    const float survival = shadow_survival_probability(radiance, context.spread);
    if (roulette >= survival) return;
    ++out.rays.shadow;
    const Passage passage = transmittance(vertex.path.scene, vertex.at.spawn_to(light));
    if (is_black(passage.fraction)) return;
    radiance *= passage.fraction / survival;
    if (!passage.is_bent) {
      const LightRoute route = context.sorter
                                   ? vertex.path.route.scattered(vertex.surface, light.wi, false, false)
                                   : vertex.path.route;
      add(out, vertex.path.depth + passage.surfaces, radiance, {context, route, light.source});
    } else if (light.is_delta && !(context.chains && passage.is_sharp &&
                                   !(vertex.path.view.is_sharp && passage.has_normal_map))) {
      out.missing.bent += radiance;
    }
  }

  /// Light of lamps by sharp lobes to where no light path can end. Kept out of the loop.
  [[gnu::noinline]] void add_chain(Estimate& out, const Vertex& vertex, int number,
                                   const SampleContext& context, Sampler& sampler) const {
    sampler.start_block(chain_blocks + uint32_t(number));
    const auto seed = uint64_t(sampler.next1_fine() * 0x1p53);
    const SpecularChains::Receiver receiver{vertex.at, vertex.surface, vertex.path.throughput,
                                            options_.russian_roulette ? context.spread : 0};
    const auto light = context.chains->sample(receiver, seed, out.rays);
    if (!light) return;
    const LightRoute route = context.sorter
                                 ? vertex.path.route.scattered(vertex.surface, light->wi, false, false)
                                 : vertex.path.route;
    add(out, vertex.path.depth + light->surfaces, light->radiance, {context, route, light->source});
    out.missing.bent += light->rest;
  }

  /// A scattering medium on the way: adds the light that it sends along it, moves `hit` to where it scatters
  /// the path, if it does, and returns the weight of what gets there. Kept out of the loop, which most scenes
  /// go through without.
  [[gnu::noinline]] Rgb scatter(Estimate& out, const Way& way, std::optional<Interaction>& hit,
                                const SampleContext& context, Sampler& sampler) const {
    const Vec2f lit_choice = sampler.next2();
    const float lit_roulette = sampler.next1();
    const double distance = sampler.next1_fine();
    const Vec2d light_point = sampler.next2_fine();
    const double light_choice = sampler.next1_fine();
    const float shadow_roulette = sampler.next1();

    const Carried& path = way.path;
    ScatteringStretch scattering(path.scene, way.segment, way.stretch, hit, path.throughput);
    const bool looks_for_light =
        options_.light_sampling != LightSampling::bsdf && way.stretch.medium.sees_lights;
    const auto add_at = [&](const Interaction& at, const Rgb& weight, const LightSample& light,
                            float roulette) {
      const Shading phase = shade(path.scene, at, -way.segment.ray.direction);
      add_direct(out, {{path.scene, path.throughput * weight, path.depth, path.route, path.view}, at, phase},
                 light, context, roulette);
    };
    if (looks_for_light)
      if (const auto lit = scattering.sample_lit(lit_choice.x, lit_choice.y))
        add_at(lit->at, lit->weight, lit->light, lit_roulette);
    const Rgb weight = scattering.sample(distance, hit);
    if (looks_for_light && hit && hit->is_in_medium())
      if (const auto light = path.scene.sample_light(*hit, light_choice, light_point))
        add_at(*hit, weight * scattering.weight(*light), *light, shadow_roulette);
    return weight;
  }

  /// Of a shadow ray that brings at most `radiance` to a pixel whose samples spread anyway. What roulette
  /// adds to their variance is bounded by what a ray brings; those that can bring a quarter of the spread or
  /// more are all traced. In a kitchen lit through its window that spares a third of the shadow rays for one
  /// percent more variance.
  float shadow_survival_probability(const Rgb& radiance, float spread) const {
    return options_.russian_roulette && spread > 0
               ? std::clamp(4 * max_component(radiance) / spread, 1 / 16.f, 1.f)
               : 1;
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_path(const IntegratorOptions& options) {
  return std::make_unique<PathIntegrator>(options);
}

}  // namespace vernier
