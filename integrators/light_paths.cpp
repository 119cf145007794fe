// SPDX-License-Identifier: Apache-2.0
#include "integrators/light_paths.h"

#include <cmath>

#include "integrators/render/render.h"
#include "integrators/scattering_stretch.h"

namespace vernier {
namespace {

/// Paths of one stream of the sampler, whose indices have 32 bits.
constexpr int stream_bits = 24;

/// The block of the sampler whose numbers show a small lamp: beyond those of vertices, media and chains.
constexpr uint32_t small_lamp_block = 1u << 22;

std::shared_ptr<const LightEmission> emission_of(const Scene& scene, LightPathKind kind) {
  if (kind == LightPathKind::none) return nullptr;
  return std::make_shared<LightEmission>(kind == LightPathKind::all ? LightEmission::of_all(scene)
                                                                    : LightEmission::of_lamps(scene));
}

/// The same place met from the side of the unit direction w.
Interaction met_from(const Interaction& at, const Vec3f& w) {
  Interaction seen = at;
  if ((dot(w, at.ng) > 0) == at.front) return seen;
  seen.front = !at.front;
  std::swap(seen.before, seen.beyond);
  return seen;
}

/// a / b by channel, where there is any b.
Rgb ratio(const Rgb& a, const Rgb& b) {
  const auto part = [](float x, float y) { return y > 0 ? x / y : 0; };
  return {part(a.x, b.x), part(a.y, b.y), part(a.z, b.z)};
}

}  // namespace

/// A light path under way.
struct LightPaths::Walk {
  Sampler sampler;
  Caught& caught;
  size_t first_splat;  ///< of this path
  LightSource source = {};
  int depth = 1;                  ///< of the light, for a camera that sees the vertex: surfaces met, and one
  int scatterings = 0;            ///< but for those passed straight on
  float audit_scale = 1;          ///< of the few paths that go on beyond the depth limit
  Vec2f lens{0, 0}, pixel{0, 0};  ///< numbers for the connection of this vertex
};

LightPaths::LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                       LightPathKind kind, SmallLamps small_lamps, const LightSorter* sorter)
    : scene_(scene),
      camera_(camera),
      kind_(kind),
      sorter_(sorter),
      options_(settings.integrator_options),
      emission_(emission_of(scene, kind)),
      small_lamps_(std::move(small_lamps)),
      filter_(settings.filter),
      crop_(rendered_part(settings)),
      has_times_(camera.moves() || scene.moves()),
      width_(settings.width),
      height_(settings.height),
      filter_reach_(settings.filter.width),
      seed_(settings.seed) {
  if (kind == LightPathKind::caustics) chains_.emplace(scene, emission_);
}

uint64_t LightPaths::paths_per_sample() const {
  const uint64_t pixels = uint64_t(width_) * uint64_t(height_);
  return emission_ ? pixels : small_lamps_.paths_per_sample();
}

void LightPaths::trace(const Id& id, Caught& caught) const {
  // No picture has that many pixels: camera samples have other streams.
  const uint32_t stream = ~uint32_t(id.index >> stream_bits);
  const auto index = uint32_t(id.index & ((uint64_t{1} << stream_bits) - 1));
  Walk walk{Sampler(stream, index, 2 * seed_ + uint64_t(id.half)), caught, caught.splats.size()};
  if (emission_) {
    const double choice = walk.sampler.next1_fine();
    const Vec2d place = walk.sampler.next2_fine();
    const Vec2f direction = walk.sampler.next2();
    const float time = has_times_ ? walk.sampler.next1() : middle_of_shutter;
    if (const auto emitted = emission_->sample(choice, place, direction, time)) follow(walk, *emitted);
  }
  if (small_lamps_.size() > 0) show_small_lamp(walk);
  for (size_t i = walk.first_splat; i < caught.splats.size(); ++i) {
    const Rgb& radiance = caught.splats[i].radiance;
    const float smallest = std::min(radiance.x, std::min(radiance.y, radiance.z));
    if (smallest >= 0 && is_finite(radiance)) continue;
    caught.splats.resize(walk.first_splat);
    if (sorter_) caught.parts.resize(walk.first_splat);
    ++caught.rejected;
    break;
  }
}

/// What the camera sees of a small lamp straight, with nothing in between that it looks through.
void LightPaths::show_small_lamp(Walk& walk) const {
  walk.sampler.start_block(small_lamp_block);
  const double choice = walk.sampler.next1_fine();
  const Vec2f place = walk.sampler.next2(), on_lens = walk.sampler.next2(), in_pixel = walk.sampler.next2();
  SmallLamps::Sample lamp = small_lamps_.sample(choice, place);
  if (has_times_) lamp.at.time = walk.sampler.next1();
  const auto view = view_of(lamp.at, on_lens, in_pixel);
  if (!view) return;
  lamp.at.front = dot(view->to_camera, lamp.at.ng) > 0;
  const Rgb emitted =
      scene_.emitted(nullptr, Ray{view->sight.origin, 0, -view->to_camera}, &lamp.at).radiance;
  if (is_black(emitted)) return;
  ++walk.caught.rays.shadow;
  Interaction at;
  static_cast<SurfacePoint&>(at) = lamp.at;
  const Passage passage = sightline(at, view->sight, view->to_camera);
  if (is_black(passage.fraction) || passage.surfaces > 0) return;
  const float pixels = lamp.area * std::abs(dot(view->to_camera, lamp.at.ng)) * view->sight.area;
  const Rgb radiance = emitted * passage.fraction * (pixels * view->pixel.weight);
  add(walk, {view->pixel.x, view->pixel.y, radiance, false});
  if (sorter_)
    sorter_->add(walk.caught.parts.back(), radiance, LightRoute(),
                 {LightSource::Kind::instance, lamp.at.instance});
}

void LightPaths::follow(Walk& walk, const LightEmission::Ray& emitted) const {
  walk.source = emitted.source;
  Segment segment = camera_segment(scene_, emitted.ray);
  Rgb flux = emitted.flux;
  for (int vertex = 1;; ++vertex) {
    const auto hit = next_vertex(walk, segment, vertex, flux);
    if (!hit) return;
    if (!hit->is_in_medium()) ++walk.depth;
    walk.sampler.start_block(uint32_t(vertex));
    walk.lens = walk.sampler.next2();
    walk.pixel = walk.sampler.next2();
    const Vec2f direction = walk.sampler.next2();
    const float lobe = walk.sampler.next1();
    float roulette = walk.sampler.next1();

    if (!hit->is_in_medium() && walk.depth == options_.max_depth + 1) {
      if (roulette >= audited_share) return;
      roulette /= audited_share;
      walk.audit_scale = 1 / audited_share;
      flux *= walk.audit_scale;
    }
    const Vec3f to_light = -segment.ray.direction;
    // As for a camera path that samples the lamp: it counts how far the first scattering is.
    Rgb arriving = flux;
    if (walk.scatterings == 0)
      arriving *= range_window(emitted.range, length_squared(hit->position - emitted.ray.origin));
    if (kind_ == LightPathKind::all || walk.scatterings > 0) connect(walk, *hit, to_light, arriving);
    const Shading lit = shade(scene_, *hit, to_light, flux);
    const auto next = lit.sample(lobe, direction);
    if (!next) return;
    if (!next->is_straight) {
      if (kind_ == LightPathKind::caustics && walk.scatterings == 0 && !next->is_delta) return;
      ++walk.scatterings;
      flux = arriving;
    }
    flux = carried_on(*hit, to_light, lit, *next, flux);
    const float survival = survival_probability(walk, vertex, ratio(flux, emitted.flux));
    if (roulette >= survival) return;
    flux /= survival;
    if (is_black(flux)) return;
    segment = hit->spawn(next->wi);
  }
}

/// Russian roulette, for a path that carries that part of what was emitted.
float LightPaths::survival_probability(const Walk& walk, int vertex, const Rgb& part) const {
  const float survival = roulette_survival(part / walk.audit_scale, vertex);
  if (walk.depth > options_.max_depth) return std::min(most_audited_survival, survival);
  return is_at_risk(options_, vertex) ? survival : 1;
}

/// Where a light path goes next: to a surface, or to a point where a medium scatters it. `flux` becomes what
/// gets there.
std::optional<Interaction> LightPaths::next_vertex(Walk& walk, const Segment& segment, int vertex,
                                                   Rgb& flux) const {
  auto hit = intersect(scene_, segment);
  ++walk.caught.rays.bounce;
  const Stretch stretch =
      scene_.volumes().stretch(segment.media, segment.ray, 0, hit ? hit->t : segment.ray.t_max);
  if (stretch.medium.scatters()) {
    walk.sampler.start_block(medium_blocks + uint32_t(vertex));
    ScatteringStretch scattering(scene_, segment, stretch, hit, flux);
    flux *= scattering.sample(walk.sampler.next1_fine(), hit);
  } else {
    flux *= transmittance(stretch);
  }
  return hit;
}

/// Flux that leaves by a direction sampled as if the light's side were the viewer's: what the surface
/// scatters from there to the light's direction, asked toward the camera (Veach 1997, eqs. 5.14 and 5.19).
Rgb LightPaths::carried_on(const Interaction& at, const Vec3f& to_light, const Shading& lit,
                           const ShadingSample& next, const Rgb& flux) const {
  if (at.is_in_medium()) return flux * next.weight;  // a phase function is the same both ways
  const Interaction seen = met_from(at, next.wi);
  const float cosines = std::abs(dot(next.wi, at.ng)) / std::abs(dot(to_light, at.ng));
  if (!next.is_delta)
    return flux * shade(scene_, seen, next.wi, flux).eval(to_light).f_cos * (cosines / next.pdf);
  // A sharp lobe has the same weight both ways but for the squared index, and but for coats and fibres, which
  // ask for the angle on their side alone.
  Rgb carried = flux * next.weight * square(next.eta);
  if (!next.is_transmitted) return carried * cosines;
  const float shading = std::abs(dot(to_light, lit.normal())) / std::abs(dot(next.wi, lit.normal()));
  if (scene_.material(at).is_layered()) {
    const Shading one_way = shade(scene_, at, to_light, carried),
                  other = shade(scene_, seen, next.wi, carried);
    carried *= next.is_straight ? ratio(other.straight(), one_way.straight())
                                : ratio(other.specular().rays.transmitted,
                                        one_way.specular().rays.transmitted * square(square(next.eta)));
  }
  return carried * (cosines * shading);
}

/// Light that arrives at a surface and is scattered straight to the camera.
void LightPaths::connect(Walk& walk, const Interaction& at, const Vec3f& to_light, const Rgb& flux) const {
  if (options_.background_apart && scene_.catches_shadow(at)) return;  // there the camera sees the shadow
  const auto view = view_of(at, walk.lens, walk.pixel);
  if (!view) return;
  const auto& [sight, to_camera, pixel] = *view;
  const Shading surface = shade(scene_, met_from(at, to_camera), to_camera, flux);
  const Rgb scattered = surface.eval(to_light).f_cos;
  if (is_black(scattered)) return;
  ++walk.caught.rays.shadow;
  const Passage passage = sightline(at, sight, to_camera);
  if (is_black(passage.fraction)) return;
  const float cosines =
      at.is_in_medium() ? 1 : std::abs(dot(to_camera, at.ng)) / std::abs(dot(to_light, at.ng));
  const Rgb radiance = flux * scattered * passage.fraction * (cosines * sight.area * pixel.weight);
  if (is_black(radiance)) return;
  const bool is_beyond = walk.depth + passage.surfaces > options_.max_depth;
  add(walk, {pixel.x, pixel.y, radiance, is_beyond});
  if (!sorter_ || is_beyond) return;
  LightRoute route = LightRoute().scattered(surface, to_light, false, false);
  if (walk.scatterings > 0) route = route.scattered(surface, to_light, false, false);
  sorter_->add(walk.caught.parts.back(), radiance, route, walk.source);
}

std::optional<LightPaths::View> LightPaths::view_of(const SurfacePoint& at, const Vec2f& on_lens,
                                                    const Vec2f& in_pixel) const {
  const auto sight =
      camera_.sight(at.position, camera_.has_lens() ? sample_disk(on_lens) : Vec2f(0, 0), at.time);
  if (!sight) return std::nullopt;
  const auto pixel = pixel_at(sight->raster, in_pixel);
  const Vec3f offset = sight->origin - at.position;
  if (!pixel || !(length_squared(offset) > 0)) return std::nullopt;
  return View{*sight, normalize(offset), *pixel};
}

/// How the camera sees a surface: along the ray that it would send there, straight through what does not bend
/// it.
Passage LightPaths::sightline(const Interaction& at, const Camera::Sight& sight,
                              const Vec3f& to_camera) const {
  const Vec3f target = offset_ray_origin(at.position, at.error, at.ng, to_camera);
  const Vec3f direction = -to_camera;
  // The media at its origin are told by all that lies along it.
  Ray ray{sight.origin, 0, direction};
  ray.time = at.time;
  Segment segment = camera_segment(scene_, ray);
  segment.ray.t_max = dot(target - sight.origin, direction);
  segment.ray.target_triangle = at.triangle();
  if (!(segment.ray.t_max > 0)) return {};
  Passage passage{camera_response(scene_, segment)};
  auto hit = intersect_from_camera(scene_, segment);
  while (hit) {
    const Rgb straight = shade(scene_, *hit, to_camera).straight();
    if (is_black(straight)) return {};
    passage.fraction *=
        transmittance(scene_.volumes().stretch(segment.media, segment.ray, 0, hit->t)) * straight;
    ++passage.surfaces;
    segment = hit->spawn(direction);
    segment.ray.t_max = dot(target - segment.ray.origin, direction);
    segment.ray.target_triangle = at.triangle();
    if (!(segment.ray.t_max > 0)) break;
    hit = intersect(scene_, segment);
  }
  // A side that the camera does not see it looks through, unless it has met another surface before.
  const bool is_boundary = at.is_in_medium() || scene_.volumes().of_instance(at.instance) != MediumStack::air;
  if (passage.surfaces == 0 && !is_boundary && !scene_.material(at).is_seen(met_from(at, to_camera).front))
    return {};
  passage.fraction *=
      transmittance(scene_.volumes().stretch(segment.media, segment.ray, 0, segment.ray.t_max));
  return passage;
}

std::optional<LightPaths::Pixel> LightPaths::pixel_at(Vec2f raster, const Vec2f& u) const {
  const auto is_near = [&](float at, int size) {
    return at >= -filter_reach_ && at <= float(size) + filter_reach_;
  };
  if (!is_near(raster.x, width_) || !is_near(raster.y, height_)) return std::nullopt;
  FilterSampler::Share row = filter_.share(raster.y, u.y);
  if (camera_.is_panorama() && (row.pixel < 0 || row.pixel >= height_)) {
    // Beyond a pole the picture goes on on its other side.
    row.pixel = row.pixel < 0 ? -1 - row.pixel : 2 * height_ - 1 - row.pixel;
    raster.x += float(width_) / 2;
  }
  FilterSampler::Share column = filter_.share(raster.x, u.x);
  if (camera_.is_panorama()) column.pixel = (column.pixel % width_ + width_) % width_;
  const int x = column.pixel - crop_.x, y = row.pixel - crop_.y;
  const float weight = column.weight * row.weight;
  if (x < 0 || y < 0 || x >= crop_.width || y >= crop_.height || !(weight > 0)) return std::nullopt;
  return Pixel{x, y, weight};
}

void LightPaths::add(Walk& walk, const Splat& splat) const {
  std::vector<Splat>& splats = walk.caught.splats;
  for (size_t i = walk.first_splat; i < splats.size(); ++i)
    if (splats[i].x == splat.x && splats[i].y == splat.y && splats[i].is_beyond == splat.is_beyond) {
      splats[i].radiance += splat.radiance;
      // The parts of the latest splat are the last.
      std::swap(splats[i], splats.back());
      if (sorter_) std::swap(walk.caught.parts[i], walk.caught.parts.back());
      return;
    }
  splats.push_back(splat);
  if (sorter_) walk.caught.parts.emplace_back();
}

std::optional<LightPaths> light_paths_of(const Scene& scene, const Camera& camera,
                                         const Integrator& integrator, const RenderSettings& settings,
                                         const LightSorter& sorter) {
  const LightPathKind kind = integrator.light_paths(scene);
  SmallLamps small_lamps;
  if (integrator.leaves_small_lamps())
    small_lamps = SmallLamps(scene, camera, settings.width, settings.height);
  std::optional<LightPaths> paths;
  if (kind != LightPathKind::none || small_lamps.size() > 0)
    paths.emplace(scene, camera, settings, kind, std::move(small_lamps),
                  sorter.is_empty() ? nullptr : &sorter);
  return paths;
}

}  // namespace vernier
