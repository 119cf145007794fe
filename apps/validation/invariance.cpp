// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/invariance.h"

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_scene = 1000;

bool same_bits(const std::optional<RawHit>& a, const std::optional<RawHit>& b) {
  if (!a || !b) return !a && !b;
  return a->t == b->t && a->u == b->u && a->v == b->v && a->instance == b->instance &&
         a->primitive == b->primitive;
}

Vec3f scaled(const Vec3f& v, int exponent) {
  return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
}

void add_unit_box(TriangleSoup& soup) {
  std::vector<Vec3f> corners(8);
  for (unsigned i = 0; i < 8; ++i) corners[i] = {float(i & 1), float(i >> 1 & 1), float(i >> 2 & 1)};
  soup.add(corners, {{0, 2, 1},
                     {1, 2, 3},
                     {4, 5, 6},
                     {5, 7, 6},
                     {0, 1, 4},
                     {1, 5, 4},
                     {2, 6, 3},
                     {3, 6, 7},
                     {0, 4, 2},
                     {2, 4, 6},
                     {1, 3, 5},
                     {3, 7, 5}});
}

}  // namespace

Count changed_by_scaling(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    TriangleSoup plain, large;
    add_random_triangles(plain, rng, 60, .5f);
    add_waves(plain, 4);
    int exponent = 0;
    while (exponent == 0) exponent = static_cast<int>(rng.below(49)) - 24;
    for (const GeometryMesh& mesh : plain.geometry().meshes) {
      std::vector<Vec3f> positions;
      for (const Vec3f& p : mesh.positions) positions.push_back(scaled(p, exponent));
      large.add(std::move(positions), {mesh.triangles.begin(), mesh.triangles.end()});
    }
    const auto a = build(plain.geometry()), b = build(large.geometry());
    Count changed{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = rng.in_cube(1.5f);
      ray.direction = rng.direction();
      Ray large_ray = ray;
      large_ray.origin = scaled(ray.origin, exponent);
      auto hit = a->closest(ray);
      if (hit) hit->t = std::ldexp(hit->t, exponent);
      changed.events += !same_bits(hit, b->closest(large_ray));
    }
    return changed;
  });
}

Count changed_by_signed_zeros(BuildAccelerator build) {
  TriangleSoup soup;
  add_unit_box(soup);
  const auto accelerator = build(soup.geometry());
  constexpr float places[] = {-1, 0, .5f, 1, 2};
  Count changed;
  for (unsigned origin = 0; origin < 125; ++origin)
    for (unsigned step = 0; step < 27; ++step) {
      Ray ray;
      ray.origin = {places[origin % 5], places[origin / 5 % 5], places[origin / 25]};
      const unsigned along_x = step % 3, along_y = step / 3 % 3, along_z = step / 9;
      ray.direction = {float(along_x) - 1, float(along_y) - 1, float(along_z) - 1};
      if (ray.direction == Vec3f{0, 0, 0}) continue;
      const auto plain = accelerator->closest(ray);
      for (unsigned signs = 1; signs < 8; ++signs) {
        Ray other = ray;
        for (int axis = 0; axis < 3; ++axis)
          if (ray.direction[axis] == 0 && (signs >> axis & 1)) other.direction[axis] = -0.f;
        ++changed.trials;
        changed.events += !same_bits(plain, accelerator->closest(other));
      }
    }
  return changed;
}

Count changed_by_rebuild(BuildAccelerator build, uint64_t rays, uint64_t seed) {
  TriangleSoup soup;
  for (int i = 0; i < 3; ++i) {
    Rng same(seed, ~uint64_t{0});
    add_random_triangles(soup, same, 200, .4f);
  }
  const auto first = build(soup.geometry()), second = build(soup.geometry());
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    Count changed{0, count};
    for (uint64_t i = 0; i < count; ++i) {
      Ray ray;
      ray.origin = rng.in_cube(2);
      ray.direction = rng.direction();
      changed.events += !same_bits(first->closest(ray), second->closest(ray));
    }
    return changed;
  });
}

}  // namespace vernier::validation
