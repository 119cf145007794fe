// SPDX-License-Identifier: Apache-2.0
#include "scene/geometry.h"

#include "core/base/parallel.h"
#include "core/math/frame.h"
#include "core/math/moments.h"
#include "scene/moving_mesh.h"

namespace vernier {
namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const Triangle& triangle, float u, float v) {
  return values[triangle[0]] * (1 - u - v) + values[triangle[1]] * u + values[triangle[2]] * v;
}

/// Embree reads four floats a vertex.
void pad(std::vector<Vec3f>& positions) { positions.reserve(positions.size() + 2); }

/// Coordinates of what moves become zero where they are next to it. Embree 3.13's builder for motion asserts
/// that centers of triangles lie within the bounds of all centers, to the bit; with coordinates of 2^-125
/// they did not, presumably since halves are no longer exact there. Multiples of 2^-119, as all that is left
/// here is, can be halved seven times.
void round_least_to_zero(std::vector<Vec3f>& positions) {
  constexpr float least = 0x1p-96f;
  for (Vec3f& p : positions)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(p[axis]) < least) p[axis] = 0;
}

Vec3f xyz(const Vec4f& v) { return {v.x, v.y, v.z}; }

/// Operations between the vertices that a mesh stores and a point of it.
constexpr int vertex_roundings = 7;

/// Triangle tests find t from the vertices as seen from the origin, so they round by the triangle's size even
/// where the point's own coordinates, and so their rounding, are zero. This much along the normal, of any
/// length; `extent`: how far a corner lies off along an axis.
[[gnu::always_inline]] inline Vec3f test_error(float extent, const Vec3f& normal) {
  const Vec3f n = abs(normal);
  const float normal_share = length(n) / std::max(n.x + n.y + n.z, std::numeric_limits<float>::min());
  return Vec3f(gamma_bound(8) * extent * normal_share);
}

/// Rounding of the local point is carried through the map, and the map's own four products and sums added;
/// the vertices that the accelerator compares against go through the inverse of the same map, hence the
/// double share.
[[gnu::always_inline]] inline Vec3f mapped_error(const Transform& map, const Vec3f& error,
                                                 const Vec3f& magnitude) {
  return map.absolute_point(error, 0) + map.absolute_point(magnitude, 1) * (2 * gamma_bound(4));
}

/// The point of a triangle in the space of its mesh, its vertices known to within rounding of `roundings`
/// operations on `magnitudes`.
[[gnu::always_inline]] inline SurfacePoint point_of(const std::array<Vec3f, 3>& corners,
                                                    const std::array<Vec3f, 3>& magnitudes, int roundings,
                                                    const Vec2f& barycentrics) {
  const auto& [p0, p1, p2] = corners;
  const auto& [m0, m1, m2] = magnitudes;
  SurfacePoint point;
  point.u = barycentrics.x;
  point.v = barycentrics.y;
  const float w = 1 - point.u - point.v;
  point.position = p0 * w + p1 * point.u + p2 * point.v;
  point.error = (m0 * std::abs(w) + m1 * std::abs(point.u) + m2 * std::abs(point.v)) * gamma_bound(roundings);
  point.ng = cross(p1 - p0, p2 - p0);
  const float extent =
      max_component(max(abs(p0 - point.position), max(abs(p1 - point.position), abs(p2 - point.position))));
  point.error = max(point.error, test_error(extent, point.ng));
  return point;
}

/// A point of a mesh that moves. Its vertices take three operations more, which accelerators may do in
/// another order: hence the double share.
[[gnu::noinline]] SurfacePoint moving_point(const MeshDescription& mesh, const Triangle& triangle,
                                            const Vec2f& barycentrics, float time) {
  const auto [first, part] = moments_around(time, mesh.moments.size());
  const MeshShape &from = mesh.moments[first], &to = mesh.moments[first + 1];
  std::array<Vec3f, 3> corners, magnitudes;
  for (size_t k = 0; k < 3; ++k) {
    const Vec3f &a = from.positions[triangle[k]], &b = to.positions[triangle[k]];
    corners[k] = between(a, b, part);
    magnitudes[k] = between(abs(a), abs(b), part);
  }
  return point_of(corners, magnitudes, vertex_roundings + 2 * 3, barycentrics);
}

}  // namespace

SceneGeometry::SceneGeometry(std::vector<MeshDescription> meshes,
                             const std::vector<InstanceDescription>& instances)
    : meshes_(std::move(meshes)) {
  std::vector<uint32_t> uses(meshes_.size(), 0);
  for (const auto& instance : instances) ++uses[instance.mesh];
  for (const auto& description : instances) {
    Instance instance{description.mesh, description.material, description.to_world, {}, false, false, 1};
    const auto inverse = instance.to_world.inverse();
    instance.normal_inverse = inverse.value_or(Transform{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
    instance.orientation = instance.to_world.determinant() < 0 ? -1.f : 1.f;
    instance.is_identity = instance.to_world.is_identity();
    instances_.push_back(instance);
  }
  for (size_t i = 0; i < instances_.size(); ++i) {
    check_moments(meshes_[instances_[i].mesh], instances[i]);
    instances_[i].moves = !instances[i].moments.empty() || !meshes_[instances_[i].mesh].moments.empty();
    if (!instances_[i].moves || uses[instances_[i].mesh] == 1) continue;
    // What moves has a mesh of its own, in world space.
    --uses[instances_[i].mesh];
    meshes_.push_back(meshes_[instances_[i].mesh]);
    uses.push_back(1);
    instances_[i].mesh = uint32_t(meshes_.size() - 1);
  }
  parallel_for(instances_.size(), [&](size_t i) {
    const bool is_placed = !instances_[i].is_identity || !instances[i].moments.empty();
    if (uses[instances_[i].mesh] == 1 && is_placed) bake(instances_[i], instances[i].moments);
  });
  extents_.resize(meshes_.size());
  parallel_for(meshes_.size(), [&](size_t i) {
    pad(meshes_[i].positions);
    for (MeshShape& shape : meshes_[i].moments) {
      round_least_to_zero(shape.positions);
      pad(shape.positions);
    }
    extents_[i] = MeshExtent(meshes_[i].positions, meshes_[i].triangles);
  });
  middle_bounds_.resize(instances_.size());
  parallel_for(instances_.size(), [&](size_t i) {
    middle_bounds_[i] = extents_[instances_[i].mesh].bounds(instances_[i].to_world);
  });
  for (uint32_t i = 0; i < instances_.size(); ++i) bounds_.add(bounds(i));
}

bool SceneGeometry::moves() const {
  return std::any_of(instances_.begin(), instances_.end(), [](const Instance& i) { return i.moves; });
}

Bounds SceneGeometry::bounds(uint32_t instance) const {
  Bounds bounds = middle_bounds_[instance];
  for (const MeshShape& shape : mesh_of(instance).moments)
    for (const Vec3f& p : shape.positions)
      if (is_finite(p)) bounds.add(p);
  return bounds;
}

void SceneGeometry::bake(Instance& instance, std::span<const Transform> moments) {
  MeshDescription& mesh = meshes_[instance.mesh];
  if (instance.moves) mesh.moments = moments_in_world(mesh, instance.to_world, moments);
  carry(instance.to_world, mesh.positions, mesh.normals, mesh.tangents);
  if (instance.orientation < 0)
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  instance.to_world = instance.normal_inverse = Transform{};
  instance.orientation = 1;
  instance.is_identity = true;
}

Geometry SceneGeometry::view() const {
  Geometry geometry;
  for (const auto& mesh : meshes_) {
    GeometryMesh& view = geometry.meshes.emplace_back(GeometryMesh{mesh.positions, mesh.triangles});
    for (const MeshShape& shape : mesh.moments) view.moments.emplace_back(shape.positions);
  }
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

std::array<Vec3f, 3> SceneGeometry::mesh_triangle(uint32_t instance, uint32_t primitive) const {
  const MeshDescription& mesh = mesh_of(instance);
  const auto [a, b, c] = mesh.triangles[primitive];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

std::array<Vec3f, 3> SceneGeometry::triangle(uint32_t instance, uint32_t primitive) const {
  const Instance& placed = instances_[instance];
  std::array<Vec3f, 3> corners = mesh_triangle(instance, primitive);
  for (Vec3f& corner : corners) corner = placed.to_world.point(corner);
  if (placed.orientation < 0) std::swap(corners[1], corners[2]);
  return corners;
}

std::array<Vec3f, 3> SceneGeometry::triangle(uint32_t instance, uint32_t primitive, float time) const {
  if (!instances_[instance].moves) return triangle(instance, primitive);
  const MeshDescription& mesh = mesh_of(instance);
  const auto [first, part] = moments_around(time, mesh.moments.size());
  const MeshShape &from = mesh.moments[first], &to = mesh.moments[first + 1];
  std::array<Vec3f, 3> corners;
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t vertex = mesh.triangles[primitive][k];
    corners[k] = between(from.positions[vertex], to.positions[vertex], part);
  }
  return corners;
}

// The bound of a point is linear in the barycentrics, so it is largest at a corner.
PlacedTriangle SceneGeometry::placed_triangle(uint32_t instance, uint32_t primitive, float time) const {
  const Instance& placed = instances_[instance];
  if (placed.moves) [[unlikely]] {
    const auto error = [&](const Vec2f& corner) {
      return surface_point(instance, primitive, corner, time).error;
    };
    return {triangle(instance, primitive, time), max(error({0, 0}), max(error({1, 0}), error({0, 1})))};
  }
  std::array<Vec3f, 3> corners = mesh_triangle(instance, primitive);
  const auto& [a, b, c] = corners;
  const Vec3f magnitude = max(abs(a), max(abs(b), abs(c)));
  const float extent = max_component(max(a, max(b, c)) - min(a, min(b, c)));
  Vec3f error = max(magnitude * gamma_bound(vertex_roundings), test_error(extent, cross(b - a, c - a)));
  if (!placed.is_identity) {
    error = mapped_error(placed.to_world, error, magnitude);
    for (Vec3f& corner : corners) corner = placed.to_world.point(corner);
  }
  return {corners, error, placed.orientation < 0};
}

SurfacePoint SceneGeometry::surface_point(uint32_t instance, uint32_t primitive,
                                          const Vec2f& barycentrics) const {
  return surface_point(instance, primitive, barycentrics, middle_of_shutter);
}

SurfacePoint SceneGeometry::surface_point(uint32_t instance, uint32_t primitive, const Vec2f& barycentrics,
                                          float time) const {
  const Instance& placed = instances_[instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  const Triangle& indices = mesh.triangles[primitive];
  SurfacePoint point;
  if (placed.moves) [[unlikely]] {
    point = moving_point(mesh, indices, barycentrics, time);
  } else {
    const Vec3f p0 = mesh.positions[indices[0]], p1 = mesh.positions[indices[1]],
                p2 = mesh.positions[indices[2]];
    point = point_of({p0, p1, p2}, {abs(p0), abs(p1), abs(p2)}, vertex_roundings, barycentrics);
  }
  point.instance = instance;
  point.primitive = primitive;
  point.time = time;
  if (!placed.is_identity) {
    point.error = mapped_error(placed.to_world, point.error, abs(point.position));
    point.position = placed.to_world.point(point.position);
    // On an inverse this keeps the side, also where the map mirrors and with that turns the winding.
    point.ng = placed.normal_inverse.transposed_vector(point.ng);
  }
  point.ng = unit_or(point.ng, {0, 0, 1});
  return point;
}

// Flat, as the hit's numbers would else be stored one by one and read together at once, which waits.
[[gnu::flatten]] SurfacePoint SceneGeometry::surface_point(const Ray& ray, const RawHit& hit) const {
  SurfacePoint point = surface_point(hit.instance, hit.primitive, {hit.u, hit.v}, ray.time);
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
  if (!mesh.more_texcoords.empty()) [[unlikely]] {
    attributes.mesh = &mesh;
    attributes.triangle = point.primitive;
    attributes.barycentrics = {point.u, point.v};
  }
  return attributes;
}

SurfaceAttributes SceneGeometry::attributes(const SurfacePoint& point, const Vec3f& w) const {
  SurfaceAttributes attributes = this->attributes(point);
  if (point.footprint > 0) [[unlikely]]
    add_footprint(attributes, point, w);
  return attributes;
}

Vec3f SceneGeometry::shading_normal(const SurfacePoint& point) const {
  const Instance& placed = instances_[point.instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  if (mesh.normals.empty()) return point.ng;
  const Triangle& triangle = mesh.triangles[point.primitive];
  if (placed.moves) [[unlikely]] {
    const auto [first, part] = moments_around(point.time, mesh.moments.size());
    const MeshShape &from = mesh.moments[first], &to = mesh.moments[first + 1];
    return unit_or(between(interpolate(from.normals, triangle, point.u, point.v),
                           interpolate(to.normals, triangle, point.u, point.v), part),
                   point.ng);
  }
  Vec3f n = interpolate(mesh.normals, triangle, point.u, point.v);
  if (!placed.is_identity) n = placed.normal_inverse.transposed_vector(n);
  return unit_or(n, point.ng);
}

std::optional<std::array<Vec3f, 3>> SceneGeometry::corner_normals(const SurfacePoint& point) const {
  const Instance& placed = instances_[point.instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  if (mesh.normals.empty()) return std::nullopt;
  const Triangle& triangle = mesh.triangles[point.primitive];
  std::array<Vec3f, 3> normals;
  for (size_t k = 0; k < 3; ++k) {
    normals[k] = mesh.normals[triangle[k]];
    if (placed.moves) {
      const auto [first, part] = moments_around(point.time, mesh.moments.size());
      normals[k] = between(mesh.moments[first].normals[triangle[k]],
                           mesh.moments[first + 1].normals[triangle[k]], part);
    }
    if (!placed.is_identity) normals[k] = placed.normal_inverse.transposed_vector(normals[k]);
  }
  if (placed.orientation < 0) std::swap(normals[1], normals[2]);
  return normals;
}

SceneGeometry::TangentFrame SceneGeometry::tangent_frame(const SurfacePoint& point, const Vec3f& normal,
                                                         int texcoord) const {
  const Instance& placed = instances_[point.instance];
  const MeshDescription& mesh = meshes_[placed.mesh];
  const Triangle& triangle = mesh.triangles[point.primitive];
  Vec3f tangent;
  float handedness;
  if (texcoord == 0 && !mesh.tangents.empty()) {
    const auto tangent_in = [&](const std::vector<Vec4f>& tangents) {
      return xyz(interpolate(tangents, triangle, point.u, point.v));
    };
    tangent = tangent_in(mesh.tangents);
    if (placed.moves) {
      const auto [first, part] = moments_around(point.time, mesh.moments.size());
      tangent = between(tangent_in(mesh.moments[first].tangents),
                        tangent_in(mesh.moments[first + 1].tangents), part);
    }
    handedness = mesh.tangents[triangle[0]].w;
  } else {
    const auto& uv = mesh.texcoord_set(size_t(texcoord));
    if (uv.empty()) {
      const Frame frame = Frame::from_normal(normal);
      return {frame.x, frame.y};
    }
    const Vec2f d1 = uv[triangle[1]] - uv[triangle[0]], d2 = uv[triangle[2]] - uv[triangle[0]];
    Vec3f e1 = mesh.positions[triangle[1]] - mesh.positions[triangle[0]];
    Vec3f e2 = mesh.positions[triangle[2]] - mesh.positions[triangle[0]];
    if (placed.moves) {
      const auto [a, b, c] = this->triangle(point.instance, point.primitive, point.time);
      e1 = b - a;
      e2 = c - a;
    }
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
