// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/agreement.h"

#include <mutex>

#include "apps/validation/excuse.h"
#include "core/base/parallel.h"
#include "scene/accel/instance.h"

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_task = 1000;

bool is_same(const std::optional<RawHit>& a, const std::optional<RawHit>& b) {
  if (!a || !b) return !a && !b;
  return a->instance == b->instance && a->primitive == b->primitive;
}

bool is_excused(const Soup& soup, const Ray& ray, const std::optional<RawHit>& a,
                const std::optional<RawHit>& b) {
  const auto corners = [&](const std::optional<RawHit>& hit) {
    return hit ? std::optional(soup.corners(hit->instance, hit->primitive)) : std::nullopt;
  };
  return excuse(ray, corners(a), corners(b)) != Excuse::none;
}

Ray random_ray(const Soup& soup, Dice& dice) {
  Ray ray;
  ray.origin = dice.in_cube(1.5f);
  ray.direction = dice.direction();
  if (dice.below(4) == 0) {
    const uint32_t instance = dice.below(static_cast<uint32_t>(soup.geometry().instances.size()));
    const auto& triangles = soup.geometry().meshes[soup.geometry().instances[instance].mesh].triangles;
    const Corners c = soup.corners(instance, dice.below(static_cast<uint32_t>(triangles.size())));
    ray.direction = (dice.below(2) ? c[0] : c[0] + (c[1] - c[0]) * dice.uniform(0, 1)) - ray.origin;
  }
  if (dice.below(8) == 0) ray.direction[static_cast<int>(dice.below(3))] = 0;
  if (dice.below(8) == 0) ray.t_max = dice.uniform(0, 2);
  return ray;
}

void add_error(HitErrors& errors, const Ray& ray, const Corners& corners, const std::optional<RawHit>& hit) {
  const ExactHit exact = intersect_exactly(ray, corners);
  const bool is_hit = exact.kind == ExactHit::Kind::hit && exact.t > ray.t_min && exact.t < ray.t_max;
  ++errors.wrong.trials;
  if (is_hit != hit.has_value() && !is_near_boundary(ray, corners)) ++errors.wrong.events;
  if (!is_hit || !hit) return;
  errors.t = std::max(errors.t, std::abs(hit->t - exact.t) / exact.t_bound);
  errors.u = std::max(errors.u, std::abs(hit->u - exact.u) / exact.u_bound);
  errors.v = std::max(errors.v, std::abs(hit->v - exact.v) / exact.v_bound);
}

/// Runs body(dice, rays, sum) for parts of the rays in parallel and joins the sums.
template <typename Sum, typename Body, typename Join>
Sum in_parts(uint64_t rays, uint64_t seed, const Body& body, const Join& join) {
  Sum all{};
  std::mutex mutex;
  parallel_for((rays + rays_a_task - 1) / rays_a_task, [&](size_t part) {
    Dice dice(seed, part);
    Sum sum{};
    body(dice, std::min(rays_a_task, rays - part * rays_a_task), sum);
    const std::lock_guard lock(mutex);
    join(all, sum);
  });
  return all;
}

void join_errors(HitErrors& all, const HitErrors& part) {
  all.wrong.events += part.wrong.events;
  all.wrong.trials += part.wrong.trials;
  all.t = std::max(all.t, part.t);
  all.u = std::max(all.u, part.u);
  all.v = std::max(all.v, part.v);
}

}  // namespace

Disagreements compare(const Accelerator& a, const Accelerator& b, const Soup& soup, uint64_t rays,
                      uint64_t seed) {
  const auto body = [&](Dice& dice, uint64_t count, Disagreements& sum) {
    for (uint64_t i = 0; i < count; ++i) {
      const Ray ray = random_ray(soup, dice);
      const auto hit_a = a.closest(ray), hit_b = b.closest(ray);
      ++sum.rays;
      if (is_same(hit_a, hit_b) && a.occluded(ray) == hit_a.has_value() &&
          b.occluded(ray) == hit_b.has_value())
        continue;
      ++(is_excused(soup, ray, hit_a, hit_b) ? sum.excused : sum.unexcused);
    }
  };
  return in_parts<Disagreements>(rays, seed, body, [](Disagreements& all, const Disagreements& part) {
    all.rays += part.rays;
    all.excused += part.excused;
    all.unexcused += part.unexcused;
  });
}

HitErrors hit_errors(BuildAccelerator build, float needle, float offset, uint64_t rays, uint64_t seed) {
  const auto body = [&](Dice& dice, uint64_t count, HitErrors& sum) {
    const Vec3f center = dice.direction() * offset;
    const Vec3f along = dice.direction(), across = normalize(cross(along, dice.direction()));
    const Vec3f tip = along * dice.uniform(.3f, .7f) + across * needle;
    Soup soup;
    soup.add({center, center + along, center + tip}, {{0, 1, 2}});
    const auto accelerator = build(soup.geometry());
    const Corners corners = soup.corners(0, 0);
    for (uint64_t i = 0; i < count; ++i) {
      const float u = dice.uniform(-.2f, 1), v = dice.uniform(-.2f, 1);
      const Vec3f target = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      Ray ray;
      ray.origin = target + dice.direction() * dice.magnitude(1, 1000);
      ray.direction = target - ray.origin;
      if (dice.below(2)) ray.direction = normalize(ray.direction);
      add_error(sum, ray, corners, accelerator->closest(ray));
    }
  };
  return in_parts<HitErrors>(rays, seed, body, join_errors);
}

HitErrors needle_errors(BuildAccelerator build, float height, uint64_t rays, uint64_t seed) {
  const auto body = [&](Dice& dice, uint64_t count, HitErrors& sum) {
    const Vec3f center = dice.in_cube(300);
    Soup soup;
    soup.add({center, center + Vec3f{11.1f, 0, 0}, center + Vec3f{9.7f, height, 0}}, {{0, 1, 2}});
    const auto accelerator = build(soup.geometry());
    const Corners corners = soup.corners(0, 0);
    for (uint64_t i = 0; i < count; ++i) {
      const float u = dice.uniform(0, 1), v = dice.uniform(0, 1 - u), angle = dice.uniform(0, 2 * pi);
      const Vec3f target = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      const float tilt = 0.5f * pi / 180;
      const Vec3f away{std::cos(tilt) * std::cos(angle), std::cos(tilt) * std::sin(angle), std::sin(tilt)};
      Ray ray;
      ray.origin = target + away * 600.f;
      ray.direction = normalize(target - ray.origin);
      add_error(sum, ray, corners, accelerator->closest(ray));
    }
  };
  return in_parts<HitErrors>(rays, seed, body, join_errors);
}

double instance_error(BuildAccelerator build, const Vec3f& scale, const Vec3f& origin, uint64_t rays,
                      uint64_t seed) {
  const auto body = [&](Dice& dice, uint64_t count, double& worst) {
    Soup placed, baked;
    const uint32_t mesh = placed.add_mesh({{0, 0, 0}, {1, 0, .1f}, {0, 1, .2f}}, {{0, 1, 2}});
    const Transform to_world = random_placement(dice, scale, origin);
    placed.add_instance(mesh, to_world);
    baked.add(bake_positions(placed.geometry().meshes[mesh], to_world), {{0, 1, 2}});
    const auto a = build(placed.geometry()), b = build(baked.geometry());
    const auto to_mesh = WorldToMesh::of(to_world);
    const double unit = std::numeric_limits<float>::epsilon() * (to_mesh ? to_mesh->distortion(to_world) : 1);
    const Corners corners = baked.corners(0, 0);
    const float size = max_component(abs(scale));
    for (uint64_t i = 0; i < count; ++i) {
      const float u = dice.uniform(.1f, .45f), v = dice.uniform(.1f, .45f);
      const Vec3f target = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      Ray ray;
      ray.origin = target + dice.direction() * (size * dice.magnitude(1, 100));
      ray.direction = target - ray.origin;
      const Vec3f n = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
      if (std::abs(dot(n, normalize(ray.direction))) < 0.1f) continue;
      const auto ha = a->closest(ray), hb = b->closest(ray);
      const double reach = length(Vec3d(ray.direction)) + length(Vec3d(ray.origin)) + length(Vec3d(origin));
      const double error =
          ha && hb ? std::abs(double(ha->t) - hb->t) * length(Vec3d(ray.direction)) / reach : 1;
      worst = std::max(worst, error / unit);
    }
  };
  return in_parts<double>(rays, seed, body, [](double& all, double part) { all = std::max(all, part); });
}

}  // namespace vernier::validation
