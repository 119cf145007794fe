// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/ray.h"
#include "vernier/scene.h"
#include "vernier/transform.h"

namespace vernier {

/// Where a ray meets a triangle: P = (1-u-v) v0 + u v1 + v v2, the convention of Moeller and Trumbore 1997
/// and of Embree. `instance` indexes Geometry::instances, `primitive` the triangles of its mesh.
struct RawHit {
  float t = 0, u = 0, v = 0;
  uint32_t instance = 0, primitive = 0;

  TriangleId triangle() const { return {instance, primitive}; }
};

/// Whether that is the triangle that the ray starts on or aims at, whose hits must be ignored.
inline bool is_endpoint_triangle(const Ray& ray, const TriangleId& met) {
  return met == ray.origin_triangle || met == ray.target_triangle;
}

/// Decides whether a hit counts (alpha coverage). Must be a pure function of its arguments and callable from
/// many threads.
class HitFilter {
 public:
  virtual ~HitFilter() = default;
  virtual bool accept(const Ray& ray, const RawHit& hit) const = 0;
};

/// Triangles in one coordinate system; the arrays must outlive the accelerator and be readable 16 bytes past
/// the last position (Embree loads four floats).
struct GeometryMesh {
  std::span<const Vec3f> positions;
  std::span<const Triangle> triangles;
  /// Of a mesh that moves, which must be in world space: its positions at two moments of the shutter or more,
  /// evenly spaced, of which the padding counts as well; between() tells the others (core/math/moments.h).
  /// Then `positions` are nothing to the accelerator.
  std::vector<std::span<const Vec3f>> moments{};

  bool moves() const { return !moments.empty(); }
};

struct GeometryInstance {
  uint32_t mesh = 0;
  Transform to_world;     ///< identity: the mesh is in world space already and
                          ///< needs no second level
  bool filtered = false;  ///< ask Geometry::filter about hits on this instance
  bool clear = false;     ///< light may pass it straight on: see Accelerator::occluded
};

struct Geometry {
  std::vector<GeometryMesh> meshes;
  std::vector<GeometryInstance> instances;
  const HitFilter* filter = nullptr;  ///< null unless some instance is filtered
};

struct AcceleratorStats {
  double build_seconds = 0;
  size_t bytes = 0;  ///< of the structure, without vertices and indices
};

/// What one query looks at.
struct QueryCost {
  size_t nodes = 0;   ///< boxes of children tested together
  size_t blocks = 0;  ///< of up to four triangles
};

/// Answers ray queries over fixed geometry. Rays may have any finite non-zero direction; an invalid ray (NaN,
/// infinite origin, zero direction) misses. Triangles with a vertex that is not finite, or with no area, are
/// never hit, nor are those that the ray leaves or reaches. Both sides of a triangle count. All queries are
/// callable from many threads.
class Accelerator {
 public:
  virtual ~Accelerator() = default;

  /// The hit with the smallest t in (t_min, t_max).
  virtual std::optional<RawHit> closest(const Ray& ray) const = 0;
  /// Whether there is any hit in (t_min, t_max).
  virtual bool occluded(const Ray& ray) const = 0;
  /// The same for hits on instances that are not clear. Those on clear ones are added to `passed`, in any
  /// order and maybe repeatedly; all of them if nothing occludes.
  virtual bool occluded(const Ray& ray, std::vector<RawHit>& passed) const = 0;
  /// Every hit in (t_min, t_max), by increasing t; replaces the contents of `sorted`. Each triangle once.
  virtual void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const = 0;

  virtual AcceleratorStats stats() const = 0;
  /// What closest(ray) looks at; empty where the accelerator cannot tell.
  virtual std::optional<QueryCost> closest_cost(const Ray&) const { return {}; }
};

/// Where rays aimed at the seam of triangles are sure to hit one of them.
enum class Watertight { nowhere, at_edges, at_edges_and_vertices };

/// One line of the table of accelerators.
struct AcceleratorEntry {
  std::string_view name;
  std::string_view description;
  Watertight watertight;
  std::unique_ptr<Accelerator> (*build)(const Geometry&);
  bool for_study = false;  ///< to compare with and to test, of no use to render with
};

/// All accelerators (scene/accel/registry.cpp).
std::span<const AcceleratorEntry> accelerators();

/// The default: what answers soonest for a geometry.
const AcceleratorEntry& quickest_accelerator(const Geometry& geometry);

}  // namespace vernier
