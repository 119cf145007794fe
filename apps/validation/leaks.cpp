// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/leaks.h"

#include "apps/validation/soup.h"

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_scene = 1000;

/// Whether all triangles of the first instance show the same side to the direction, none at a grazing angle.
bool all_face(const Soup& soup, const Vec3f& direction) {
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
Count aim_at(const Accelerator& accelerator, const Soup& soup, const Aim& aim, Dice& dice, uint64_t rays,
             const Target& target) {
  Count count;
  while (count.trials < rays) {
    const Vec3f point = target();
    Ray ray;
    ray.origin = point + dice.direction() * (aim.distance * aim.size);
    ray.direction = point - ray.origin;
    if (!all_face(soup, ray.direction)) continue;
    if (dice.below(2)) ray.direction = normalize(ray.direction);
    ++count.trials;
    count.events += is_let_through(accelerator, ray);
  }
  return count;
}

/// A point on a random edge of the soup's first mesh, or one of its vertices.
Vec3f point_where_triangles_meet(const Soup& soup, Dice& dice) {
  const GeometryMesh& mesh = soup.geometry().meshes[0];
  const Triangle& triangle = mesh.triangles[dice.below(static_cast<uint32_t>(mesh.triangles.size()))];
  const Vec3f &a = mesh.positions[triangle[0]], &b = mesh.positions[triangle[1]];
  return dice.below(2) ? a : a + (b - a) * dice.uniform(.05f, .95f);
}

constexpr unsigned blob_levels = 4;

}  // namespace

Count leaks_at_edges(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Dice& dice, uint64_t count) {
    Soup soup;
    add_folded_quad(soup, dice, aim.size, aim.center);
    const Vec3f a = soup.positions(0)[1], b = soup.positions(0)[2];
    return aim_at(*build(soup.geometry()), soup, aim, dice, count,
                  [&] { return a + (b - a) * dice.uniform(.05f, .95f); });
  });
}

Count leaks_at_vertices(BuildAccelerator build, const Aim& aim, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Dice& dice, uint64_t count) {
    Soup soup;
    add_fan(soup, dice, aim.size, aim.center + dice.in_cube(aim.size));
    return aim_at(*build(soup.geometry()), soup, aim, dice, count, [&] { return soup.positions(0)[0]; });
  });
}

Count leaks_of_closed_surface(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  Dice shape(seed, ~uint64_t{0});
  Soup soup;
  add_blob(soup, shape, blob_levels, 1, {0, 0, 0});
  const auto accelerator = build(soup.geometry());
  return count_portions(rays, rays_a_scene, seed, [&](Dice& dice, uint64_t count) {
    Count leaks{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = dice.in_cube(0.3f);
      ray.direction = point_where_triangles_meet(soup, dice) - ray.origin;
      leaks.events += is_let_through(*accelerator, ray);
    }
    return leaks;
  });
}

Count parity_errors(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  Dice shape(seed, ~uint64_t{0});
  Soup soup;
  add_blob(soup, shape, blob_levels, 1, {0, 0, 0});
  const auto accelerator = build(soup.geometry());
  return count_portions(rays, rays_a_scene, seed, [&](Dice& dice, uint64_t count) {
    Count errors{0, count};
    std::vector<RawHit> hits;
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = dice.direction() * 5.f;
      ray.direction = point_where_triangles_meet(soup, dice) - ray.origin;
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
