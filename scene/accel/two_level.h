// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <tuple>
#include <unordered_map>

#include "scene/accel/accelerator.h"
#include "scene/accel/instance.h"
#include "scene/accel/moving_tree.h"
#include "scene/accel/query.h"
#include "scene/accel/triangle_set.h"
#include "scene/accel/wide_tree.h"

namespace vernier {

/// What `bvh`, `list`, `octree` and `brute_force` share: a Structure over all triangles in world space, one
/// for each mesh that is placed by a transform, a tree over those instances, and one Moving for what moves,
/// for each number of moments. Of hits at the same t, the first by instance and primitive wins, so all
/// Structures give the same answers to the bit.
///
/// Structure: Structure(TriangleSet), bounds(), bytes(), and
///   bool traverse<ordered>(const Ray&, QueryCost*, Blocks&&)
/// which shows every TriangleBlock that may hold a hit in (t_min, blocks.t_max()] to blocks.visit(), or every
/// hit there, unless blocks.passes_over() its triangle, to blocks.meet(), until that returns true, near ones
/// first if ordered. Test: WatertightTest or MoellerTrumboreTest. Moving: as MovingTree.
template <typename Structure, typename Test, typename Moving = MovingTree>
class TwoLevel : public Accelerator {
 public:
  explicit TwoLevel(const Geometry& geometry);

  std::optional<RawHit> closest(const Ray& ray) const override { return nearest(ray, nullptr); }
  bool occluded(const Ray& ray) const override;
  bool occluded(const Ray& ray, std::vector<RawHit>& passed) const override;
  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override;
  std::optional<QueryCost> closest_cost(const Ray& ray) const override;
  AcceleratorStats stats() const override { return stats_; }

  /// After vertices have moved: new boxes for the same trees. Answers stay right however far the vertices
  /// went, but rays slow down as the trees fit worse. Triangles that were left out of the build, because no
  /// ray could hit them, stay left out.
  void refit();

 private:
  /// A mesh placed in the world.
  struct Placed {
    uint32_t mesh, instance;  ///< index into meshes_, into Geometry::instances
    WorldToMesh to_mesh;
  };

  // What a query does with the hits in (t_min, t_max]: offer() returns true to stop.
  struct Nearest {
    float t_max;
    std::optional<RawHit> hit;
    bool offer(const RawHit& h);
  };
  struct Any {
    float t_max;
    bool offer(const RawHit&) { return true; }
  };
  struct AnyNotClear {
    float t_max;
    const std::vector<GeometryInstance>& instances;
    std::vector<RawHit>& passed;
    bool offer(const RawHit& h) {
      if (!instances[h.instance].clear) return true;
      passed.push_back(h);
      return false;
    }
  };
  struct All {
    float t_max;
    std::vector<RawHit>& hits;
    bool offer(const RawHit& h) { return hits.push_back(h), false; }
  };

  std::optional<RawHit> nearest(const Ray& ray, QueryCost* cost) const;

  // Both inline: where there is but a short list to search, calls are a tenth of a query.
  template <bool ordered, typename Hits>
  bool search(Ray ray, QueryCost* cost, Hits& hits) const;

  /// In one structure; `local` is the ray in its space, `placed` null in world space.
  template <bool ordered, typename Triangles, typename Hits>
  bool search(const Triangles& structure, const Placed* placed, const Ray& local, const Ray& world,
              QueryCost* cost, Hits& hits) const;

  void build();
  Bounds world_box(const Placed& placed) const;
  void bound_carrying_error();

  Geometry geometry_;
  bool has_clear_;
  std::vector<std::vector<Vec3f>> baked_;
  std::vector<uint32_t> baked_instance_;
  Structure world_;
  std::vector<Structure> meshes_;
  std::vector<Moving> moving_;
  std::vector<Placed> placed_;  ///< by leaf of tree_
  WideTree tree_;
  // A ray carried into a mesh's space is rounded there. Seen from the world that moves it by at most
  // `distortion_` times the rounding of its distance from the corners of `reach_`.
  Bounds reach_;
  float distortion_ = 1;
  AcceleratorStats stats_;
};

template <typename Structure, typename Test, typename Moving>
bool TwoLevel<Structure, Test, Moving>::Nearest::offer(const RawHit& h) {
  const auto order = [](const RawHit& x) { return std::tuple(x.t, x.instance, x.primitive); };
  if (!hit || order(h) < order(*hit)) {
    hit = h;
    t_max = h.t;
  }
  return false;
}

template <typename Structure, typename Test, typename Moving>
std::optional<RawHit> TwoLevel<Structure, Test, Moving>::nearest(const Ray& ray, QueryCost* cost) const {
  if (!is_traceable(ray)) return {};
  Nearest hits{below(ray.t_max), {}};
  search<true>(ray, cost, hits);
  return hits.hit;
}

template <typename Structure, typename Test, typename Moving>
bool TwoLevel<Structure, Test, Moving>::occluded(const Ray& ray) const {
  if (!is_traceable(ray)) return false;
  Any hits{below(ray.t_max)};
  return search<false>(ray, nullptr, hits);
}

template <typename Structure, typename Test, typename Moving>
bool TwoLevel<Structure, Test, Moving>::occluded(const Ray& ray, std::vector<RawHit>& passed) const {
  if (!has_clear_) return occluded(ray);
  if (!is_traceable(ray)) return false;
  AnyNotClear hits{below(ray.t_max), geometry_.instances, passed};
  return search<false>(ray, nullptr, hits);
}

template <typename Structure, typename Test, typename Moving>
void TwoLevel<Structure, Test, Moving>::all_hits(const Ray& ray, std::vector<RawHit>& sorted) const {
  sorted.clear();
  if (!is_traceable(ray)) return;
  All hits{below(ray.t_max), sorted};
  search<false>(ray, nullptr, hits);
  sort_hits(sorted);
}

template <typename Structure, typename Test, typename Moving>
std::optional<QueryCost> TwoLevel<Structure, Test, Moving>::closest_cost(const Ray& ray) const {
  QueryCost cost;
  nearest(ray, &cost);
  return cost;
}

template <typename Structure, typename Test, typename Moving>
template <bool ordered, typename Hits>
[[gnu::always_inline]] inline bool TwoLevel<Structure, Test, Moving>::search(Ray ray, QueryCost* cost,
                                                                             Hits& hits) const {
  ray.t_min = std::max(ray.t_min, 0.f);
  if (search<ordered>(world_, nullptr, ray, ray, cost, hits)) return true;
  for (const Moving& moving : moving_)
    if (search<ordered>(moving, nullptr, ray, ray, cost, hits)) return true;
  if (tree_.empty()) return false;

  struct Instances {
    const TwoLevel& self;
    const Ray& world;
    QueryCost* cost;
    Hits& hits;

    float t_max() const { return hits.t_max; }
    void prefetch(uint32_t) const {}
    bool visit(uint32_t leaf) {
      const Placed& placed = self.placed_[leaf];
      Ray local = world;
      local.origin = placed.to_mesh.point(world.origin);
      local.direction = placed.to_mesh.vector(world.direction);
      return is_traceable(local) &&
             self.search<ordered>(self.meshes_[placed.mesh], &placed, local, world, cost, hits);
    }
  };
  const SlabRay slab_ray(ray.origin, ray.direction, reach_, distortion_);
  return tree_.traverse<ordered>(slab_ray, ray.t_min, cost, Instances{*this, ray, cost, hits});
}

template <typename Structure, typename Test, typename Moving>
template <bool ordered, typename Triangles, typename Hits>
[[gnu::always_inline]] inline bool TwoLevel<Structure, Test, Moving>::search(
    const Triangles& structure, const Placed* placed, const Ray& local, const Ray& world, QueryCost* cost,
    Hits& hits) const {
  struct Blocks {
    const Geometry& geometry;
    const Placed* placed;
    const Ray& world;
    typename Test::Ray ray;
    QueryCost* cost;
    Hits& hits;

    float t_max() const { return hits.t_max; }
    bool visit(const TriangleBlock& block) {
      if (cost) ++cost->blocks;
      BlockHits found;
      for (unsigned lanes = Test::test(block, ray, world.t_min, hits.t_max, found); lanes;
           lanes &= lanes - 1) {
        const auto lane = lowest(lanes);
        const uint32_t instance = block.instance[lane], primitive = block.primitive[lane];
        if (passes_over(instance, primitive)) continue;
        if (meet({found.t[lane], found.u[lane], found.v[lane], instance, primitive})) return true;
      }
      return false;
    }
    uint32_t instance_of(uint32_t instance) const { return placed ? placed->instance : instance; }
    /// Whether the ray leaves or reaches that triangle.
    bool passes_over(uint32_t instance, uint32_t primitive) const {
      return is_endpoint_triangle(world, {instance_of(instance), primitive});
    }
    /// A hit on another.
    bool meet(RawHit hit) {
      hit.instance = instance_of(hit.instance);
      const bool filtered = geometry.filter && geometry.instances[hit.instance].filtered;
      return (!filtered || geometry.filter->accept(world, hit)) && hits.offer(hit);
    }
  };
  const typename Test::Ray ray(local.origin, local.direction);
  return structure.template traverse<ordered>(local, cost, Blocks{geometry_, placed, world, ray, cost, hits});
}

template <typename Structure, typename Test, typename Moving>
TwoLevel<Structure, Test, Moving>::TwoLevel(const Geometry& geometry)
    : geometry_(geometry), has_clear_(has_clear_instances(geometry)) {
  const auto start = std::chrono::steady_clock::now();
  build();
  stats_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  stats_.bytes = world_.bytes() + tree_.bytes() + placed_.capacity() * sizeof(Placed);
  for (const Structure& mesh : meshes_) stats_.bytes += mesh.bytes();
  for (const Moving& moving : moving_) stats_.bytes += moving.bytes();
  for (const auto& positions : baked_) stats_.bytes += positions.size() * sizeof(Vec3f);
}

template <typename Structure, typename Test, typename Moving>
void TwoLevel<Structure, Test, Moving>::build() {
  TriangleSet in_world;
  std::map<size_t, TriangleSet> moving;                 // by number of moments
  std::unordered_map<uint32_t, uint32_t> structure_of;  // mesh to index into meshes_
  std::vector<Placed> placed;
  for (uint32_t id = 0; id < geometry_.instances.size(); ++id) {
    const GeometryInstance& instance = geometry_.instances[id];
    const GeometryMesh& mesh = geometry_.meshes[instance.mesh];
    if (mesh.moves()) {
      moving[mesh.moments.size()].add(mesh, id);
    } else if (instance.to_world.is_identity()) {
      in_world.add(mesh, id);
    } else if (const auto to_mesh = WorldToMesh::of(instance.to_world)) {
      const auto [entry, is_new] =
          structure_of.try_emplace(instance.mesh, static_cast<uint32_t>(meshes_.size()));
      if (is_new) {
        TriangleSet in_mesh;
        in_mesh.add(mesh, id);
        meshes_.emplace_back(std::move(in_mesh));
      }
      placed.push_back({entry->second, id, *to_mesh});
    } else {
      baked_.push_back(bake_positions(mesh, instance.to_world));
      baked_instance_.push_back(id);
      in_world.add({baked_.back(), mesh.triangles}, id);
    }
  }
  world_ = Structure(std::move(in_world));
  for (auto& [moments, triangles] : moving)
    moving_.emplace_back(MovingTriangles{moments, std::move(triangles)});
  std::vector<BuildItem> items;
  for (uint32_t i = 0; i < placed.size(); ++i)
    if (const Bounds box = world_box(placed[i]); !box.empty()) items.push_back({box, i});
  tree_ = WideTree(items, 1);
  for (const WideTree::Leaf& leaf : tree_.take_leaves()) placed_.push_back(placed[items[leaf.first].id]);
  bound_carrying_error();
}

template <typename Structure, typename Test, typename Moving>
Bounds TwoLevel<Structure, Test, Moving>::world_box(const Placed& placed) const {
  return transformed_box(meshes_[placed.mesh].bounds(), geometry_.instances[placed.instance].to_world);
}

template <typename Structure, typename Test, typename Moving>
void TwoLevel<Structure, Test, Moving>::bound_carrying_error() {
  reach_ = tree_.bounds();
  for (const Placed& placed : placed_) {
    const Transform& to_world = geometry_.instances[placed.instance].to_world;
    reach_.add(to_world.origin);
    distortion_ = std::max(distortion_, static_cast<float>(placed.to_mesh.distortion(to_world)));
  }
}

template <typename Structure, typename Test, typename Moving>
void TwoLevel<Structure, Test, Moving>::refit() {
  for (size_t i = 0; i < baked_.size(); ++i) {
    const GeometryInstance& instance = geometry_.instances[baked_instance_[i]];
    const auto positions = bake_positions(geometry_.meshes[instance.mesh], instance.to_world);
    std::copy(positions.begin(), positions.end(),
              baked_[i].begin());  // in place: the structure points there
  }
  world_.refit();
  for (Structure& mesh : meshes_) mesh.refit();
  for (Moving& moving : moving_) moving.refit();
  tree_.refit([&](uint32_t leaf) { return world_box(placed_[leaf]); });
  bound_carrying_error();
}

}  // namespace vernier
