// SPDX-License-Identifier: Apache-2.0
#include "scene/geometry.h"

#include "core/base/parallel.h"
#include "core/math/frame.h"

namespace vernier {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const Triangle& triangle, float u, float v) {
  return values[triangle[0]] * (1 - u - v) + values[triangle[1]] * u + values[triangle[2]] * v;
}

/// Embree reads four floats a vertex.
void pad(std::vector<Vec3f>& positions) { positions.reserve(positions.size() + 2); }

Vec3f xyz(const Vec4f& v) { return {v.x, v.y, v.z}; }

/// n scaled to unit length; `otherwise` when it has none.
Vec3f unit_or(const Vec3f& n, const Vec3f& otherwise) {
  const float length2 = length_squared(n);
  return length2 > 0 && std::isfinite(length2) ? n * (1 / std::sqrt(length2)) : otherwise;
}

}  // namespace

SceneGeometry::SceneGeometry(std::vector<MeshDescription> meshes,
                             const std::vector<InstanceDescription>& instances)
    : meshes_(std::move(meshes)) {
  std::vector<uint32_t> uses(meshes_.size(), 0);
  for (const auto& instance : instances) ++uses[instance.mesh];
  for (const auto& description : instances) {
    Instance instance{description.mesh, description.material, description.to_world, {}, false, 1};
    const auto inverse = instance.to_world.inverse();
    instance.normal_inverse = inverse.value_or(Transform{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    instance.orientation = instance.to_world.determinant() < 0 ? -1.f : 1.f;
    instance.is_identity = instance.to_world.is_identity();
    instances_.push_back(instance);
  }
  parallel_for(instances_.size(), [&](size_t i) {
    if (uses[instances_[i].mesh] == 1 && !instances_[i].is_identity) bake(instances_[i]);
  });
  for (auto& mesh : meshes_) pad(mesh.positions);
  for (uint32_t i = 0; i < instances_.size(); ++i)
    for (const Vec3f& p : mesh_of(i).positions)
      if (const Vec3f world = instances_[i].to_world.point(p); is_finite(world)) bounds_.add(world);
}

void SceneGeometry::bake(Instance& instance) {
  MeshDescription& mesh = meshes_[instance.mesh];
  const Transform& to_world = instance.to_world;
  for (Vec3f& p : mesh.positions) p = to_world.point(p);
  for (Vec3f& n : mesh.normals) n = unit_or(instance.normal_inverse.transposed_vector(n), {0, 0, 0});
  for (Vec4f& t : mesh.tangents) {
    const Vec3f moved = unit_or(to_world.vector(xyz(t)), {1, 0, 0});
    t = {moved.x, moved.y, moved.z, t.w * instance.orientation};
  }
  if (instance.orientation < 0)
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  instance.to_world = instance.normal_inverse = Transform{};
  instance.orientation = 1;
  instance.is_identity = true;
}

Geometry SceneGeometry::view() const {
  Geometry geometry;
  for (const auto& mesh : meshes_) geometry.meshes.push_back({mesh.positions, mesh.triangles});
  for (const auto& instance : instances_)
    geometry.instances.push_back({instance.mesh, instance.to_world, false});
  return geometry;
}

size_t SceneGeometry::stored_triangles() const {
  size_t count = 0;
  for (const auto& mesh : meshes_) count += mesh.triangles.size();
  return count;
}

size_t SceneGeometry::instanced_triangles() const {
  size_t count = 0;
  for (uint32_t i = 0; i < instances_.size(); ++i) count += triangle_count(i);
  return count;
}

std::array<Vec3f, 3> SceneGeometry::triangle(uint32_t instance, uint32_t primitive) const {
  const Instance& placed = instances_[instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  const Triangle& indices = mesh.triangles[primitive];
  std::array<Vec3f, 3> corners;
  for (size_t k = 0; k < 3; ++k) corners[k] = placed.to_world.point(mesh.positions[indices[k]]);
  if (placed.orientation < 0) std::swap(corners[1], corners[2]);
  return corners;
}

SurfacePoint SceneGeometry::surface_point(uint32_t instance, uint32_t primitive,
                                          const Vec2f& barycentrics) const {
  const Instance& placed = instances_[instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  const Triangle& indices = mesh.triangles[primitive];
  const Vec3f p0 = mesh.positions[indices[0]], p1 = mesh.positions[indices[1]],
              p2 = mesh.positions[indices[2]];
  SurfacePoint point;
  point.u = barycentrics.x;
  point.v = barycentrics.y;
  point.instance = instance;
  point.primitive = primitive;
  const float w = 1 - point.u - point.v;
  point.position = p0 * w + p1 * point.u + p2 * point.v;
  point.error =
      (abs(p0) * std::abs(w) + abs(p1) * std::abs(point.u) + abs(p2) * std::abs(point.v)) * gamma_bound(7);
  point.ng = cross(p1 - p0, p2 - p0);
  // Triangle tests find t from the vertices as seen from the origin, so they round by the triangle's size
  // even where the point's own coordinates, and so their rounding, are nought. This much along the normal.
  const float extent =
      max_component(max(abs(p0 - point.position), max(abs(p1 - point.position), abs(p2 - point.position))));
  const Vec3f n = abs(point.ng);
  const float normal_share = length(n) / std::max(n.x + n.y + n.z, std::numeric_limits<float>::min());
  point.error = max(point.error, Vec3f(gamma_bound(8) * extent * normal_share));
  if (!placed.is_identity) {
    // Rounding of the local point is carried through the map, and the map's own four products and sums added;
    // the vertices that the accelerator compares against go through the inverse of the same map, hence the
    // double share.
    const Transform& m = placed.to_world;
    point.error =
        m.absolute_point(point.error, 0) + m.absolute_point(abs(point.position), 1) * (2 * gamma_bound(4));
    point.position = m.point(point.position);
    point.ng = placed.normal_inverse.transposed_vector(point.ng) * placed.orientation;
  }
  point.ng = unit_or(point.ng, {0, 0, 1});
  return point;
}

SurfacePoint SceneGeometry::surface_point(const Ray& ray, const RawHit& hit) const {
  SurfacePoint point = surface_point(hit.instance, hit.primitive, {hit.u, hit.v});
  point.t = hit.t;
  point.front = dot(ray.direction, point.ng) < 0;
  return point;
}

float SceneGeometry::least_alpha(uint32_t instance) const {
  float least = 1;
  for (const Vec4f& color : mesh_of(instance).colors) least = std::min(least, color.w);
  return least;
}

SurfaceAttributes SceneGeometry::attributes(const SurfacePoint& point) const {
  const MeshDescription& mesh = mesh_of(point.instance);
  const Triangle& triangle = mesh.triangles[point.primitive];
  SurfaceAttributes attributes;
  for (size_t set = 0; set < 2; ++set)
    if (!mesh.texcoords[set].empty())
      attributes.uv[set] = interpolate(mesh.texcoords[set], triangle, point.u, point.v);
  if (!mesh.colors.empty()) attributes.color = interpolate(mesh.colors, triangle, point.u, point.v);
  return attributes;
}

Vec3f SceneGeometry::shading_normal(const SurfacePoint& point) const {
  const Instance& placed = instances_[point.instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  if (mesh.normals.empty()) return point.ng;
  Vec3f n = interpolate(mesh.normals, mesh.triangles[point.primitive], point.u, point.v);
  if (!placed.is_identity) n = placed.normal_inverse.transposed_vector(n);
  return unit_or(n, point.ng);
}

SceneGeometry::TangentFrame SceneGeometry::tangent_frame(const SurfacePoint& point, const Vec3f& normal,
                                                         int texcoord) const {
  const Instance& placed = instances_[point.instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  const Triangle& triangle = mesh.triangles[point.primitive];
  Vec3f tangent;
  float handedness;
  if (texcoord == 0 && !mesh.tangents.empty()) {
    tangent = xyz(interpolate(mesh.tangents, triangle, point.u, point.v));
    handedness = mesh.tangents[triangle[0]].w;
  } else {
    const auto& uv = mesh.texcoords[size_t(texcoord)];
    if (uv.empty()) {
      const Frame frame = Frame::from_normal(normal);
      return {frame.x, frame.y};
    }
    const Vec2f d1 = uv[triangle[1]] - uv[triangle[0]], d2 = uv[triangle[2]] - uv[triangle[0]];
    const Vec3f e1 = mesh.positions[triangle[1]] - mesh.positions[triangle[0]];
    const Vec3f e2 = mesh.positions[triangle[2]] - mesh.positions[triangle[0]];
    const float determinant = d1.x * d2.y - d1.y * d2.x;
    // glTF's v runs down the picture, its tangent space's up: the bitangent follows -v.
    tangent = (e1 * d2.y - e2 * d1.y) * std::copysign(1.f, determinant);
    handedness = determinant > 0 ? -1.f : 1.f;
  }
  if (!placed.is_identity) {
    tangent = placed.to_world.vector(tangent);
    handedness *= placed.orientation;
  }
  const Frame frame = Frame::from_normal_tangent(normal, tangent);
  return {frame.x, frame.y * handedness};
}

}  // namespace vernier
