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

bool is_within_rounding(const TriangleSoup& soup, const Ray& ray, const std::optional<RawHit>& a,
                        const std::optional<RawHit>& b) {
  const auto corners = [&](const std::optional<RawHit>& hit) {
    return hit ? std::optional(soup.corners(hit->instance, hit->primitive)) : std::nullopt;
  };
  return excuse(ray, corners(a), corners(b)) != Excuse::none;
}

Ray random_ray(const TriangleSoup& soup, Rng& rng) {
  Ray ray;
  ray.origin = rng.in_cube(1.5f);
  ray.direction = rng.direction();
  if (rng.below(4) == 0) {
    const uint32_t instance = rng.below(static_cast<uint32_t>(soup.geometry().instances.size()));
    const auto& triangles = soup.geometry().meshes[soup.geometry().instances[instance].mesh].triangles;
    const Corners c = soup.corners(instance, rng.below(static_cast<uint32_t>(triangles.size())));
    ray.direction = (rng.below(2) ? c[0] : c[0] + (c[1] - c[0]) * rng.uniform(0, 1)) - ray.origin;
  }
  if (rng.below(8) == 0) ray.direction[static_cast<int>(rng.below(3))] = 0;
  if (rng.below(8) == 0) ray.t_max = rng.uniform(0, 2);
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

/// Runs body(rng, rays, sum) for parts of the rays in parallel and joins the sums.
template <typename Sum, typename Body, typename Join>
Sum in_parts(uint64_t rays, uint64_t seed, const Body& body, const Join& join) {
  Sum all{};
  std::mutex mutex;
  parallel_for((rays + rays_a_task - 1) / rays_a_task, [&](size_t part) {
    Rng rng(seed, part);
    Sum sum{};
    body(rng, std::min(rays_a_task, rays - part * rays_a_task), sum);
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

Disagreements compare(const Accelerator& a, const Accelerator& b, const TriangleSoup& soup, uint64_t rays,
                      uint64_t seed) {
  const auto body = [&](Rng& rng, uint64_t count, Disagreements& sum) {
    for (uint64_t i = 0; i < count; ++i) {
      const Ray ray = random_ray(soup, rng);
      const auto hit_a = a.closest(ray), hit_b = b.closest(ray);
      ++sum.rays;
      if (is_same(hit_a, hit_b) && a.occluded(ray) == hit_a.has_value() &&
          b.occluded(ray) == hit_b.has_value())
        continue;
      ++(is_within_rounding(soup, ray, hit_a, hit_b) ? sum.within_rounding : sum.real);
    }
  };
  return in_parts<Disagreements>(rays, seed, body, [](Disagreements& all, const Disagreements& part) {
    all.rays += part.rays;
    all.within_rounding += part.within_rounding;
    all.real += part.real;
  });
}

HitErrors hit_errors(BuildAccelerator build, float needle, float offset, uint64_t rays, uint64_t seed) {
  const auto body = [&](Rng& rng, uint64_t count, HitErrors& sum) {
    const Vec3f center = rng.direction() * offset;
    const Vec3f along = rng.direction(), across = normalize(cross(along, rng.direction()));
    const Vec3f tip = along * rng.uniform(.3f, .7f) + across * needle;
    TriangleSoup soup;
    soup.add({center, center + along, center + tip}, {{0, 1, 2}});
    const auto accelerator = build(soup.geometry());
    const Corners corners = soup.corners(0, 0);
    for (uint64_t i = 0; i < count; ++i) {
      const float u = rng.uniform(-.2f, 1), v = rng.uniform(-.2f, 1);
      const Vec3f target = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      Ray ray;
      ray.origin = target + rng.direction() * rng.magnitude(1, 1000);
      ray.direction = target - ray.origin;
      if (rng.below(2)) ray.direction = normalize(ray.direction);
      add_error(sum, ray, corners, accelerator->closest(ray));
    }
  };
  return in_parts<HitErrors>(rays, seed, body, join_errors);
}

HitErrors needle_errors(BuildAccelerator build, float height, uint64_t rays, uint64_t seed) {
  const auto body = [&](Rng& rng, uint64_t count, HitErrors& sum) {
    const Vec3f center = rng.in_cube(300);
    TriangleSoup soup;
    soup.add({center, center + Vec3f{11.1f, 0, 0}, center + Vec3f{9.7f, height, 0}}, {{0, 1, 2}});
    const auto accelerator = build(soup.geometry());
    const Corners corners = soup.corners(0, 0);
    for (uint64_t i = 0; i < count; ++i) {
      const float u = rng.uniform(0, 1), v = rng.uniform(0, 1 - u), angle = rng.uniform(0, 2 * pi);
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
  const auto body = [&](Rng& rng, uint64_t count, double& worst) {
    TriangleSoup placed, baked;
    const uint32_t mesh = placed.add_mesh({{0, 0, 0}, {1, 0, .1f}, {0, 1, .2f}}, {{0, 1, 2}});
    const Transform to_world = random_placement(rng, scale, origin);
    placed.add_instance(mesh, to_world);
    baked.add(bake_positions(placed.geometry().meshes[mesh], to_world), {{0, 1, 2}});
    const auto a = build(placed.geometry()), b = build(baked.geometry());
    const auto to_mesh = WorldToMesh::of(to_world);
    const double unit = std::numeric_limits<float>::epsilon() * (to_mesh ? to_mesh->distortion(to_world) : 1);
    const Corners corners = baked.corners(0, 0);
    const float size = max_component(abs(scale));
    for (uint64_t i = 0; i < count; ++i) {
      const float u = rng.uniform(.1f, .45f), v = rng.uniform(.1f, .45f);
      const Vec3f target = corners[0] + (corners[1] - corners[0]) * u + (corners[2] - corners[0]) * v;
      Ray ray;
      ray.origin = target + rng.direction() * (size * rng.magnitude(1, 100));
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
