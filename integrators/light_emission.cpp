// SPDX-License-Identifier: Apache-2.0
#include "integrators/light_emission.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/sampling/sampler.h"
#include "materials/ggx.h"
#include "scene/segment.h"

namespace vernier {
namespace {

/// Rays that look where lamps shine; a lamp has a square number of them.
constexpr size_t rays_to_aim = 1 << 16, rays_to_decide = 1 << 13;
constexpr int most_cells = 256, fewest_cells = 8;  // a side
/// Of the light paths of a lamp, and of all lamps, those that find what these rays have missed.
constexpr float unaimed_share = 0.1f, unaimed_power = 0.02f;
/// Light paths cost about as much as camera samples: not for less than this part of what lamps send.
constexpr double least_sharp_share = 1e-4;
/// Panes that a ray passes straight before nothing is expected of it any more.
constexpr int most_panes = 16;

float sum(const Rgb& c) { return c.x + c.y + c.z; }

/// What part of a ray's light the first surfaces mirror or bend sharply.
float sharp_part(const Scene& scene, const LightRay& light) {
  Segment segment = camera_segment(scene, light.ray);
  Rgb left(1, 1, 1);
  float sharp = 0;
  for (int pane = 0; pane < most_panes; ++pane) {
    const auto hit = intersect(scene, segment);
    if (!hit) break;
    left *= transmittance(scene.volumes().stretch(segment.media, segment.ray, 0, hit->t));
    const Shading surface = shade(scene, *hit, -segment.ray.direction);
    const Rgb straight = surface.straight();
    const SpecularRays rays = surface.specular().rays;
    if (rays.alpha < Ggx::smooth_limit) {
      const Rgb bent = is_black(straight) ? rays.transmitted : Rgb(0, 0, 0);
      sharp += std::min(1.f, sum(left * (rays.reflected + bent)) / 3);
    }
    left *= straight;
    if (is_black(left)) break;
    segment = hit->spawn(segment.ray.direction);
  }
  return sharp;
}

/// Where a lamp's light is mirrored or bent, over the square of places that Light::emit takes.
std::vector<float> sharp_light(const Scene& scene, const Light& lamp, uint32_t number, int cells) {
  std::vector<float> values(size_t(cells) * size_t(cells));
  parallel_for(values.size(), [&](size_t i) {
    Sampler sampler(number, uint32_t(i), 0);
    const Vec2d in_cell(sampler.next2());
    const size_t column = i % size_t(cells), row = i / size_t(cells);
    const Vec2d corner{double(column), double(row)};
    const auto light =
        lamp.emit(scene.lit_bounds(), (corner + in_cell) / double(cells), {0.5f, 0.5f}, middle_of_shutter);
    if (light) values[i] = luminance(light->flux) * sharp_part(scene, *light);
  });
  return values;
}

/// Surfaces may reach into cells whose ray has missed them.
std::vector<float> spread_out(const std::vector<float>& values, int cells) {
  std::vector<float> spread(values.size());
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      for (int j = std::max(0, y - 1); j <= std::min(cells - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(cells - 1, x + 1); ++i) {
          float& value = spread[size_t(y) * size_t(cells) + size_t(x)];
          value = std::max(value, values[size_t(j) * size_t(cells) + size_t(i)]);
        }
  return spread;
}

int cells_a_side(size_t lamps, size_t rays) {
  const double side = std::sqrt(double(rays) / double(std::max<size_t>(1, lamps)));
  return int(std::clamp(side, double(fewest_cells), double(most_cells)));
}

float mean(const std::vector<float>& values) {
  double total = 0;
  for (const float value : values) total += double(value);
  return float(total / double(values.size()));
}

bool has_sharp_surface(const Scene& scene) {
  for (uint32_t i = 0; i < scene.geometry().instance_count(); ++i) {
    SurfacePoint point;
    point.instance = i;
    if (scene.material(point).may_be_sharp()) return true;
  }
  return false;
}

}  // namespace

LightEmission LightEmission::of_all(const Scene& scene) {
  LightEmission emission(scene);
  std::vector<float> powers;
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    emission.lights_.push_back(&scene.lights()[i]);
    powers.push_back(
        std::min(scene.lights()[i].power(scene.lit_bounds()), std::numeric_limits<float>::max()));
  }
  emission.by_power_ = AliasTable(powers);
  return emission;
}

LightEmission LightEmission::of_lamps(const Scene& scene) {
  LightEmission emission(scene);
  emission.lights_ = scene.lights().delta_lights();
  const int cells = cells_a_side(emission.lights_.size(), rays_to_aim);
  std::vector<float> weights;
  for (const Light* lamp : emission.lights_) {
    std::vector<float> sharp = sharp_light(scene, *lamp, uint32_t(weights.size()), cells);
    const float power = lamp->power(scene.lit_bounds());
    weights.push_back(mean(sharp) + unaimed_power * power);
    sharp = spread_out(sharp, cells);
    const float everywhere = unaimed_share / (1 - unaimed_share) * mean(sharp);
    for (float& value : sharp) value += everywhere;
    emission.aims_.emplace_back(sharp, cells, cells);
  }
  emission.by_power_ = AliasTable(weights);
  return emission;
}

LightEmission::Choice LightEmission::choose(double u) const {
  const size_t light = by_power_.sample(u);
  return {light, by_power_.prob(light)};
}

std::optional<LightRay> LightEmission::shine(size_t light, const Vec2d& place, const Vec2f& direction,
                                             float time) const {
  float density = 1;
  Vec2d aimed = place;
  if (!aims_.empty() && !aims_[light].empty()) aimed = Vec2d(aims_[light].sample(place, density));
  auto ray = lights_[light]->emit(bounds_, aimed, direction, time);
  if (!ray || !(density > 0)) return std::nullopt;
  ray->flux /= density;
  return ray;
}

std::optional<LightEmission::Ray> LightEmission::sample(double u, const Vec2d& place, const Vec2f& direction,
                                                        float time) const {
  if (empty()) return std::nullopt;
  const auto [i, prob] = choose(u);
  const auto light = shine(i, place, direction, time);
  if (!light || !(prob > 0)) return std::nullopt;
  Ray ray{*light, lights_[i]->source()};
  ray.flux /= prob;
  return ray;
}

bool casts_caustics(const Scene& scene) {
  const auto& lamps = scene.lights().delta_lights();
  if (lamps.empty() || !has_sharp_surface(scene)) return false;
  const int cells = cells_a_side(lamps.size(), rays_to_decide);
  double sharp = 0, power = 0;
  for (uint32_t i = 0; i < lamps.size(); ++i) {
    sharp += double(mean(sharp_light(scene, *lamps[i], i, cells)));
    power += double(lamps[i]->power(scene.lit_bounds()));
  }
  return sharp > least_sharp_share * power;
}

bool follows_caustics(const IntegratorOptions& options, const Scene& scene) {
  return options.caustics == Caustics::on ||
         (options.caustics == Caustics::automatic && casts_caustics(scene));
}

}  // namespace vernier
