// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/leaks.h"

#include "apps/validation/soup.h"

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_scene = 1000;

/// Whether all triangles of the first instance show the same side to the direction, none at a grazing angle.
bool all_face(const TriangleSoup& soup, const Vec3f& direction) {
  int facing = 0, count = 0;
  for (uint32_t i = 0; i < soup.geometry().meshes[0].triangles.size(); ++i, ++count) {
    const Corners c = soup.corners(0, i);
    const float cosine = dot(normalize(cross(c[1] - c[0], c[2] - c[0])), normalize(direction));
    if (std::abs(cosine) < 0.02f) return false;
    facing += cosine < 0 ? 1 : -1;
  }
  return std::abs(facing) == count;
}

bool is_let_through(const Accelerator& accelerator, const Ray& ray) {
  return !accelerator.closest(ray) || !accelerator.occluded(ray);
}

/// Rays from a random side of the soup at what target() returns; half with unit directions, as from a camera,
/// half with the difference of the points, as to a light.
template <typename Target>
Count aim_at(const Accelerator& accelerator, const TriangleSoup& soup, const Aim& aim, Rng& rng,
             uint64_t rays, const Target& target) {
  Count count;
  while (count.trials < rays) {
    const Vec3f point = target();
    Ray ray;
    ray.origin = point + rng.direction() * (aim.distance * aim.size);
    ray.direction = point - ray.origin;
    if (!all_face(soup, ray.direction)) continue;
    if (rng.below(2)) ray.direction = normalize(ray.direction);
    ++count.trials;
    count.events += is_let_through(accelerator, ray);
  }
  return count;
}

/// A point on a random edge of the soup's first mesh, or one of its vertices.
Vec3f point_where_triangles_meet(const TriangleSoup& soup, Rng& rng) {
  const GeometryMesh& mesh = soup.geometry().meshes[0];
  const Triangle& triangle = mesh.triangles[rng.below(static_cast<uint32_t>(mesh.triangles.size()))];
  const Vec3f &a = mesh.positions[triangle[0]], &b = mesh.positions[triangle[1]];
  return rng.below(2) ? a : a + (b - a) * rng.uniform(.05f, .95f);
}

constexpr unsigned blob_levels = 4;

}  // namespace

Count leaks_at_edges(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    TriangleSoup soup;
    add_folded_quad(soup, rng, aim.size, aim.center);
    const Vec3f a = soup.positions(0)[1], b = soup.positions(0)[2];
    return aim_at(*build(soup.geometry()), soup, aim, rng, count,
                  [&] { return a + (b - a) * rng.uniform(.05f, .95f); });
  });
}

Count leaks_at_vertices(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    TriangleSoup soup;
    add_fan(soup, rng, aim.size, aim.center + rng.in_cube(aim.size));
    return aim_at(*build(soup.geometry()), soup, aim, rng, count, [&] { return soup.positions(0)[0]; });
  });
}

Count leaks_of_closed_surface(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  Rng shape(seed, ~uint64_t{0});
  TriangleSoup soup;
  add_blob(soup, shape, blob_levels, 1, {0, 0, 0});
  const auto accelerator = build(soup.geometry());
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    Count leaks{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = rng.in_cube(0.3f);
      ray.direction = point_where_triangles_meet(soup, rng) - ray.origin;
      leaks.events += is_let_through(*accelerator, ray);
    }
    return leaks;
  });
}

Count parity_errors(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  Rng shape(seed, ~uint64_t{0});
  TriangleSoup soup;
  add_blob(soup, shape, blob_levels, 1, {0, 0, 0});
  const auto accelerator = build(soup.geometry());
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    Count errors{0, count};
    std::vector<RawHit> hits;
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = rng.direction() * 5.f;
      ray.direction = point_where_triangles_meet(soup, rng) - ray.origin;
      accelerator->all_hits(ray, hits);
      int inside = 0;
      for (const RawHit& hit : hits) {
        const Corners c = soup.corners(hit.instance, hit.primitive);
        inside += dot(cross(c[1] - c[0], c[2] - c[0]), ray.direction) < 0 ? 1 : -1;
      }
      errors.events += inside != 0;
    }
    return errors;
  });
}

}  // namespace vernier::validation
