// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "materials/material.h"
#include "scene/accel/accelerator.h"
#include "scene/bounds.h"
#include "scene/mesh_extent.h"
#include "scene/surface_point.h"

namespace vernier {

/// A triangle in the world.
struct PlacedTriangle {
  std::array<Vec3f, 3> corners;  ///< in the mesh's order, which is that of barycentrics
  Vec3f error;                   ///< bound on that of each of its points, as SurfacePoint::error
  bool is_mirrored = false;      ///< the corners are clockwise seen from its front
};

/// The scene's triangles: meshes, their instances, and what lies at a point of one. A mesh with a single
/// instance is moved into world space at construction, so that most scenes need one level only; so is what
/// moves, to where it is at each of its moments. Where no time is given, it is the middle of the shutter.
class SceneGeometry {
 public:
  /// Throws Error(usage) on moments that there cannot be.
  SceneGeometry(std::vector<MeshDescription> meshes, const std::vector<InstanceDescription>& instances);
  SceneGeometry(const SceneGeometry&) = delete;
  SceneGeometry& operator=(const SceneGeometry&) = delete;

  /// View of it for accelerators; valid as long as this object. No instance is filtered.
  Geometry view() const;
  /// Over all of the shutter.
  const Bounds& bounds() const { return bounds_; }
  Bounds bounds(uint32_t instance) const;
  /// In the middle of the shutter: about the corners of its triangles, and which of these lies farthest.
  const Bounds& middle_bounds(uint32_t instance) const { return middle_bounds_[instance]; }
  FarthestCorner farthest_corner(uint32_t instance, const Vec3f& direction) const {
    return extents_[instances_[instance].mesh].farthest(instances_[instance].to_world, direction);
  }

  /// At how many moments it is known where an instance is; 0: it stands still.
  size_t moments(uint32_t instance) const { return mesh_of(instance).moments.size(); }
  bool moves() const;

  size_t instance_count() const { return instances_.size(); }
  size_t triangle_count(uint32_t instance) const { return mesh_of(instance).triangles.size(); }
  uint32_t material_of(uint32_t instance) const { return instances_[instance].material; }
  /// Instances of the same number have their mesh in common.
  uint32_t mesh_number(uint32_t instance) const { return instances_[instance].mesh; }
  /// From the space of its mesh, as this stores it.
  const Transform& to_world(uint32_t instance) const { return instances_[instance].to_world; }
  bool has_colors(uint32_t instance) const { return !mesh_of(instance).colors.empty(); }
  /// Of the vertex colors; 1 without any.
  float least_alpha(uint32_t instance) const;
  size_t stored_triangles() const;
  size_t instanced_triangles() const;

  /// Corners of a triangle in the space of its mesh, in the mesh's order.
  std::array<Vec3f, 3> mesh_triangle(uint32_t instance, uint32_t primitive) const;
  /// World-space corners of a triangle in winding order (counter-clockwise seen from its front).
  std::array<Vec3f, 3> triangle(uint32_t instance, uint32_t primitive) const;
  std::array<Vec3f, 3> triangle(uint32_t instance, uint32_t primitive, float time) const;
  /// With what rounding may make of it, for lights that are looked at very often.
  PlacedTriangle placed_triangle(uint32_t instance, uint32_t primitive, float time) const;
  /// Normals at these corners, world space, front side, of any length: between them it is those that are
  /// interpolated, and then made unit vectors. Empty where a mesh has none.
  std::optional<std::array<Vec3f, 3>> corner_normals(const SurfacePoint& point) const;

  SurfacePoint surface_point(const Ray& ray, const RawHit& hit) const;
  /// Point of a triangle by barycentrics, with its error bound; t and front are not set.
  SurfacePoint surface_point(uint32_t instance, uint32_t primitive, const Vec2f& barycentrics) const;
  SurfacePoint surface_point(uint32_t instance, uint32_t primitive, const Vec2f& barycentrics,
                             float time) const;

  SurfaceAttributes attributes(const SurfacePoint& point) const;
  /// The same of a point that is met along the unit direction w or against it: with the footprint, if it has
  /// one.
  SurfaceAttributes attributes(const SurfacePoint& point, const Vec3f& w) const;

  /// World-space unit normal interpolated from the vertices (the geometric one where a mesh has none), front
  /// side.
  Vec3f shading_normal(const SurfacePoint& point) const;

  /// World-space tangent frame for normal maps and anisotropy along texture set `texcoord`, front side: the
  /// file's tangents for set 0, else the direction in which u grows on the triangle.
  struct TangentFrame {
    Vec3f tangent, bitangent;
  };
  TangentFrame tangent_frame(const SurfacePoint& point, const Vec3f& normal, int texcoord) const;

 private:
  void add_footprint(SurfaceAttributes& attributes, const SurfacePoint& point, const Vec3f& w) const;

  struct Instance {
    uint32_t mesh = 0, material = 0;
    Transform to_world;
    Transform normal_inverse;  ///< inverse of to_world; its transposed_vector maps normals
    bool is_identity = true;
    bool moves = false;     ///< its mesh has moments
    float orientation = 1;  ///< -1: to_world mirrors, and with it the winding
  };

  const MeshDescription& mesh_of(uint32_t instance) const { return meshes_[instances_[instance].mesh]; }
  void bake(Instance& instance, std::span<const Transform> moments);

  std::vector<MeshDescription> meshes_;
  std::vector<Instance> instances_;
  std::vector<MeshExtent> extents_;    ///< by mesh
  std::vector<Bounds> middle_bounds_;  ///< by instance
  Bounds bounds_;
};

}  // namespace vernier
