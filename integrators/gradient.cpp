// SPDX-License-Identifier: Apache-2.0
#include "integrators/gradient_sample.h"
#include "integrators/light_emission.h"
#include "integrators/manifold.h"
#include "integrators/scattering_stretch.h"
#include "integrators/shift.h"
#include "integrators/small_lamps.h"

namespace vernier {
namespace {

/// Gradient-domain path tracing (Kettunen, Manzi, Aittala, Lehtinen, Durand and Zwicker 2015): the paths of
/// the integrator `path`, and of each the differences to its shifts into the four pixels beside, each sample
/// of either pixel being one of two techniques for the same difference.
///
/// What narrow lobes alone show the camera is no part of the differences, GradientSample::primal_only: a
/// shift of it is another thing altogether, and rare bright differences would be spread over pixels that have
/// no such light. Nor is what SpecularChains find, nor what light paths bring.
class GradientIntegrator : public Integrator {
 public:
  explicit GradientIntegrator(const IntegratorOptions& options) : options_(options) {}

  bool wants_gradients() const override { return true; }
  bool leaves_small_lamps() const override { return true; }
  LightPathKind light_paths(const Scene& scene) const override {
    return follows_caustics(options_, scene) ? LightPathKind::caustics : LightPathKind::none;
  }

  Estimate estimate(const Scene& scene, const Ray& camera_ray, Sampler& sampler,
                    const SampleContext& context) const override {
    Estimate out;
    GradientSample unwanted;
    Paths paths{scene, context, out, context.gradients ? *context.gradients : unwanted, {}};
    Segment segment = camera_segment(scene, camera_ray);
    Rgb throughput = camera_response(scene, segment);
    float eta_scale = 1, audit_scale = 1;
    Scattering last;
    auto hit = intersect_from_camera(scene, segment);
    ++out.rays.camera;
    out.met_surface = hit.has_value();
    throughput *= loss_along(scene, segment, hit);
    if (is_black(throughput)) return out;
    std::optional<Shading> surface;
    if (hit) {
      surface.emplace(shade(scene, *hit, -segment.ray.direction, throughput));
      paths.begin_shifts(camera_ray);
    }

    for (int vertex = 1, depth = 1;; ++vertex) {
      paths.depth = depth;
      if (!(vertex == 1 && is_brought(context, hit))) add_emission(paths, last, segment.ray, hit, throughput);
      if (!hit) break;
      for (Shift& shift : paths.shifts)
        if (shift.has_left()) shift.end();

      sampler.start_block(uint32_t(vertex));
      const Vec2d light_point = sampler.next2_fine();
      const Vec2f direction = sampler.next2();
      const double light_choice = sampler.next1_fine();
      const float lobe_choice = sampler.next1();
      float roulette = sampler.next1();

      if (depth == options_.max_depth) {
        if (roulette >= audited_share) break;
        roulette /= audited_share;
        audit_scale = 1 / audited_share;
        throughput *= audit_scale;
        for (Shift& shift : paths.shifts) shift.end();
      }
      paths.depth = ++depth;
      const Vertex here{throughput, last, *hit, *surface, light_choice, light_point};
      add_direct(paths, here);
      if (context.chains && last.view.is_sharp) add_chain(paths, here, vertex, sampler);

      const auto next = surface->sample(lobe_choice, direction);
      if (!next) break;
      throughput *= next->weight;
      if (is_black(throughput)) break;
      eta_scale *= next->eta * next->eta;
      const float survival =
          survival_probability(options_, vertex, depth, throughput * (eta_scale / audit_scale));
      if (roulette >= survival) break;
      throughput /= survival;
      const SurfacePoint before = *hit;
      last.leave(before, *next);
      segment = hit->spawn(next->wi);
      hit = intersect(scene, segment);
      ++out.rays.bounce;
      const Rgb loss = loss_along(scene, segment, hit);
      throughput *= loss;
      if (is_black(throughput)) break;
      if (hit) surface.emplace(shade(scene, *hit, -segment.ray.direction, throughput));
      const bool can_be_joined =
          paths.has_separate() && Shift::is_broad(*next) && (!hit || Shift::is_broad(*surface));
      const PathStep step{lobe_choice, direction, *next,         before,    segment,
                          hit,         loss,      can_be_joined, throughput};
      for (Shift& shift : paths.shifts)
        if (!shift.is_dead())
          shift.follow(scene, step, {survival, is_at_risk(options_, vertex), vertex}, out.rays);
    }
    return out;
  }

 private:
  /// How the base path's ray came to be.
  struct Scattering {
    std::optional<SurfacePoint> from;  ///< none: the camera
    float pdf = 0;
    bool is_delta = true;
    bool is_narrow = true;  ///< by narrow lobes alone since the camera
    SharpView view;

    void leave(const SurfacePoint& at, const ShadingSample& next) {
      is_narrow = is_narrow && Shift::is_narrow(next.is_delta, next.pdf);
      if (next.is_straight) return;
      from = at;
      pdf = next.pdf;
      is_delta = next.is_delta;
      view.scatter(is_delta);
    }
  };

  /// The base path's answer, and its shifts.
  struct Paths {
    const Scene& scene;
    const SampleContext& context;
    Estimate& out;
    GradientSample& sample;
    std::array<Shift, PixelNeighbors::count> shifts;
    int depth = 1;

    void begin_shifts(const Ray& base) {
      for (size_t i = 0; i < shifts.size(); ++i)
        if (sample.active[i]) shifts[i].begin(scene, sample.rays[i], base, out.rays);
    }
    bool has_separate() const {
      return std::any_of(shifts.begin(), shifts.end(), [](const Shift& s) { return s.is_separate(); });
    }
    void add_primal_only(const Rgb& radiance) {
      out.radiance += radiance;
      sample.primal_only += radiance;
    }
    /// Light that the base path finds, and of_shift(shift) that a live one does; by narrow lobes alone it is
    /// no part of the difference.
    template <typename OfShift>
    void add(Rgb base, bool is_narrow, const OfShift& of_shift) {
      out.radiance += base;
      if (is_narrow) {
        sample.primal_only += base;
        base = Rgb(0, 0, 0);
      }
      for (size_t i = 0; i < shifts.size(); ++i) {
        if (!sample.active[i]) continue;
        const Rgb shifted = shifts[i].is_dead() ? Rgb(0, 0, 0) : of_shift(shifts[i]);
        sample.differences[i] += (shifted - base) * shifts[i].weight();
      }
    }
  };

  static bool is_brought(const SampleContext& context, const std::optional<Interaction>& hit) {
    return context.small_lamps && hit && context.small_lamps->contains(*hit);
  }

  void add_emission(Paths& paths, const Scattering& last, const Ray& ray,
                    const std::optional<Interaction>& hit, const Rgb& throughput) const {
    const LightEval light =
        paths.scene.emitted(last.is_delta ? nullptr : &*last.from, ray, hit ? &*hit : nullptr);
    const Rgb radiance = throughput * light.radiance * emission_weight(last.is_delta, last.pdf, light.pdf);
    if (paths.depth > options_.max_depth) {
      paths.out.missing.depth += radiance;
      return;
    }
    paths.add(radiance, last.is_narrow,
              [&](const Shift& shift) { return shift.emission(paths.scene, light, last.is_delta); });
  }

  /// Where a path may be lit.
  struct Vertex {
    Rgb throughput;
    const Scattering& last;  ///< that led there
    const Interaction& at;
    const Shading& surface;
    double light_choice;
    Vec2d light_point;
  };

  /// Next-event estimation, with the same random numbers where a shift has a vertex of its own.
  void add_direct(Paths& paths, const Vertex& vertex) const {
    const Scene& scene = paths.scene;
    const auto light = scene.sample_light(vertex.at, vertex.light_choice, vertex.light_point);
    std::optional<Passage> passage;
    const auto from_base = [&](const Shading& surface) {
      return light ? lit(paths, vertex.at, surface, *light, passage) : Lit{};
    };
    const Lit found = from_base(vertex.surface);
    paths.out.missing.depth += vertex.throughput * found.beyond;
    const bool by_other_paths = passage && paths.context.chains && passage->is_sharp &&
                                !(vertex.last.view.is_sharp && passage->has_normal_map);
    if (!by_other_paths) paths.out.missing.bent += vertex.throughput * found.bent;
    paths.add(vertex.throughput * found.radiance, vertex.last.is_narrow && found.is_narrow,
              [&](const Shift& shift) {
                if (shift.state() == Shift::State::merged) return shift.throughput() * found.radiance;
                if (shift.state() == Shift::State::joined)
                  return shift.throughput() * from_base(shift.surface()).radiance;
                const auto own = scene.sample_light(shift.at(), vertex.light_choice, vertex.light_point);
                std::optional<Passage> own_passage;
                if (!own) return Rgb(0, 0, 0);
                const Lit its = lit(paths, shift.at(), shift.surface(), *own, own_passage);
                return shift.is_narrow() && its.is_narrow ? Rgb(0, 0, 0) : shift.throughput() * its.radiance;
              });
  }

  /// Light of lamps by sharp lobes to where no light path can end.
  void add_chain(Paths& paths, const Vertex& vertex, int number, Sampler& sampler) const {
    const SampleContext& context = paths.context;
    sampler.start_block(chain_blocks + uint32_t(number));
    const auto seed = uint64_t(sampler.next1_fine() * 0x1p53);
    const SpecularChains::Receiver receiver{vertex.at, vertex.surface, vertex.throughput,
                                            options_.russian_roulette ? context.spread : 0};
    const auto light = context.chains->sample(receiver, seed, paths.out.rays);
    if (!light) return;
    if (paths.depth + light->surfaces <= options_.max_depth)
      paths.add_primal_only(light->radiance);
    else
      paths.out.missing.depth += light->radiance;
    paths.out.missing.bent += light->rest;
  }

  /// What a vertex sends on of a light, over the throughput that it has.
  struct Lit {
    Rgb radiance{0, 0, 0};
    Rgb beyond{0, 0, 0};  ///< the same beyond the depth limit
    Rgb bent{0, 0, 0};    ///< the same by lamps through glass that bends it, at most
    bool is_narrow = false;
  };

  /// `passage` is asked for once for all that see the light from the same place.
  Lit lit(Paths& paths, const Interaction& at, const Shading& surface, const LightSample& light,
          std::optional<Passage>& passage) const {
    Lit result;
    const BsdfEval scattered = surface.eval(light.wi);
    if (is_black(scattered.f_cos)) return result;
    result.is_narrow = Shift::is_narrow(false, scattered.pdf);
    if (!passage) {
      ++paths.out.rays.shadow;
      passage = transmittance(paths.scene, at.spawn_to(light));
    }
    const float weight = light.is_delta ? 1 : power_heuristic(light.pdf, scattered.pdf);
    const Rgb radiance = light.radiance * scattered.f_cos * passage->fraction * (weight / light.pdf);
    if (passage->is_bent) {
      if (light.is_delta) result.bent = radiance;
    } else {
      (paths.depth + passage->surfaces <= options_.max_depth ? result.radiance : result.beyond) = radiance;
    }
    return result;
  }

  IntegratorOptions options_;
};

}  // namespace

std::unique_ptr<Integrator> make_gradient(const IntegratorOptions& options) {
  return std::make_unique<GradientIntegrator>(options);
}

}  // namespace vernier
