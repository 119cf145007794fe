// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/spawning.h"

#include "apps/validation/soup.h"
#include "core/math/frame.h"
#include "scene/geometry.h"

namespace vernier::validation {
namespace {

constexpr uint64_t rays_a_scene = 250;

/// A scene with one mesh; twice when instanced, so that SceneGeometry does not bake it.
SceneGeometry make_scene(std::vector<Vec3f> positions, std::vector<Triangle> triangles,
                         const Transform& to_world, bool instanced) {
  MeshDescription mesh;
  mesh.positions = std::move(positions);
  mesh.triangles = std::move(triangles);
  std::vector<InstanceDescription> instances(1);
  instances[0].to_world = to_world;
  if (instanced) {
    instances.push_back(instances[0]);
    instances[1].to_world.origin +=
        Vec3f(max_component(abs(to_world.origin)) + 100 * max_component(abs(to_world.x)));
  }
  std::vector<MeshDescription> meshes;
  meshes.push_back(std::move(mesh));
  return SceneGeometry(std::move(meshes), instances);
}

Ray spawned(const SurfacePoint& point, const Vec3f& direction, Spawn spawn) {
  if (spawn == Spawn::error_bounds) return point.spawn(direction);
  const float side = dot(direction, point.ng) < 0 ? -1.f : 1.f;
  return {point.position + point.ng * (side * 1e-4f), 0, direction};
}

/// Unit direction at cosine `cosine` to the normal.
Vec3f leaving(const Vec3f& normal, float cosine, Rng& rng) {
  const Frame frame = Frame::from_normal(normal);
  const float angle = rng.uniform(0, 2 * pi), sine = safe_sqrt(1 - cosine * cosine);
  return frame.to_world({sine * std::cos(angle), sine * std::sin(angle), cosine});
}

/// A ray at a random point inside triangle 0 (or its copy) from a few times its size away; empty when that is
/// not what it hits.
std::optional<SurfacePoint> point_on(const SceneGeometry& scene, const Accelerator& accelerator, float scale,
                                     Rng& rng) {
  const auto c = scene.triangle(0, 0);
  const float u = rng.uniform(.05f, .9f), v = rng.uniform(.05f, .95f - u);
  const Vec3f target = c[0] + (c[1] - c[0]) * u + (c[2] - c[0]) * v;
  Ray ray;
  ray.origin = target + rng.direction() * (scale * rng.magnitude(.1f, 30));
  ray.direction = normalize(target - ray.origin);
  const auto hit = accelerator.closest(ray);
  if (!hit || hit->instance != 0) return {};
  return scene.surface_point(ray, *hit);
}

}  // namespace

Count self_hits(BuildAccelerator build, const SpawnCase& spawn_case, uint64_t rays, uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    const float scale = spawn_case.scale;
    const Vec3f center = rng.direction() * (spawn_case.offset * scale);
    const Vec3f in_mesh = spawn_case.instanced ? rng.in_cube(scale) : center;
    std::vector<Vec3f> positions(3);
    for (Vec3f& p : positions) p = in_mesh + rng.in_cube(scale);
    // A quarter lies in a coordinate plane, where points are known exactly and only the test rounds.
    if (rng.below(4) == 0) {
      const int axis = int(rng.below(3));
      for (Vec3f& p : positions) p[axis] = in_mesh[axis];
    }
    const Vec3f stretch{1, rng.magnitude(.1f, 10), rng.magnitude(.1f, 10)};
    const Transform to_world = spawn_case.instanced ? random_placement(rng, stretch, center) : Transform{};
    std::vector<Triangle> triangles(spawn_case.copied ? 2 : 1, Triangle{0, 1, 2});
    const SceneGeometry scene = make_scene(positions, std::move(triangles), to_world, spawn_case.instanced);
    const auto accelerator = build(scene.view());
    Count result;
    std::vector<RawHit> hits;
    for (uint64_t i = 0; i < count; ++i) {
      const auto point = point_on(scene, *accelerator, scale, rng);
      if (!point) continue;
      const float cosine = rng.magnitude(1e-4f, 1) * (rng.below(2) ? 1.f : -1.f);
      accelerator->all_hits(spawned(*point, leaving(point->ng, cosine, rng), spawn_case.spawn), hits);
      ++result.trials;
      result.events += std::any_of(hits.begin(), hits.end(), [](const RawHit& h) { return h.instance == 0; });
    }
    return result;
  });
}

Count missed_gaps(BuildAccelerator build, const SpawnCase& spawn_case, unsigned gap, uint64_t rays,
                  uint64_t seed) {
  return count_portions(rays, rays_a_scene, seed, [&](Rng& rng, uint64_t count) {
    const Vec3f center = rng.direction() * (spawn_case.offset * spawn_case.scale);
    // Coordinates in multiples of the ulp of the largest, so that the second sheet is moved exactly; sheets
    // many ulps wide, so that no ray leaves the gap at the side.
    const auto ulp_at = [](float x) { return std::nextafter(x, std::numeric_limits<float>::infinity()) - x; };
    const float size = std::max(spawn_case.scale, 0x1p17f * ulp_at(max_component(abs(center))));
    const float ulp = ulp_at(max_component(abs(center)) + size);
    std::vector<Vec3f> positions;
    Vec3f normal{0, 0, 0};
    while (length(normal) < 0.1f * size * size) {  // nor slivers, for the same reason
      positions.clear();
      for (int i = 0; i < 3; ++i) {
        Vec3f p = center + rng.in_cube(size);
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] / ulp) * ulp;
        positions.push_back(p);
      }
      normal = cross(positions[1] - positions[0], positions[2] - positions[0]);
    }
    const int axis = std::abs(normal.x) > std::abs(normal.y)
                         ? (std::abs(normal.x) > std::abs(normal.z) ? 0 : 2)
                         : (std::abs(normal.y) > std::abs(normal.z) ? 1 : 2);
    const float shift = std::ceil(float(gap) * length(normal) / std::abs(normal[axis])) * ulp;
    for (size_t i = 0; i < 3; ++i) {
      Vec3f p = positions[i];
      p[axis] += shift;
      positions.push_back(p);
    }
    const SceneGeometry scene = make_scene(positions, {{0, 1, 2}, {3, 4, 5}}, {}, false);
    const auto accelerator = build(scene.view());
    Count result;
    for (uint64_t i = 0; i < count; ++i) {
      const float u = rng.uniform(.2f, .5f), v = rng.uniform(.2f, .7f - u);
      const SurfacePoint point = scene.surface_point(0, 0, {u, v});
      const float toward = normal[axis] > 0 ? 1.f : -1.f;
      const Vec3f direction = leaving(point.ng * toward, rng.uniform(.1f, 1), rng);
      ++result.trials;
      result.events += !accelerator->occluded(spawned(point, direction, spawn_case.spawn));
    }
    return result;
  });
}

unsigned smallest_gap(BuildAccelerator build, const SpawnCase& spawn_case, uint64_t rays, uint64_t seed) {
  unsigned smallest = 0;
  for (unsigned gap = 256; gap >= 1; gap /= 2) {
    if (missed_gaps(build, spawn_case, gap, rays, seed).events > 0) break;
    smallest = gap;
  }
  return smallest;
}

}  // namespace vernier::validation
