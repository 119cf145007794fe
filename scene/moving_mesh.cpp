// SPDX-License-Identifier: Apache-2.0
#include "scene/moving_mesh.h"

#include <fmt/format.h>

#include <bit>

#include "core/math/moments.h"

namespace vernier {
namespace {

template <typename T>
std::vector<T> between_all(const std::vector<T>& a, const std::vector<T>& b, float part) {
  std::vector<T> values(a.size());
  for (size_t i = 0; i < a.size(); ++i) values[i] = between(a[i], b[i], part);
  return values;
}

MeshShape shape_at(const MeshDescription& mesh, float time) {
  if (mesh.moments.empty()) return {mesh.positions, mesh.normals, mesh.tangents};
  const auto [first, part] = moments_around(time, mesh.moments.size());
  const MeshShape &from = mesh.moments[first], &to = mesh.moments[first + 1];
  if (part == 0) return from;
  MeshShape shape{between_all(from.positions, to.positions, part),
                  between_all(from.normals, to.normals, part), between_all(from.tangents, to.tangents, part)};
  for (size_t i = 0; i < shape.tangents.size(); ++i) shape.tangents[i].w = from.tangents[i].w;
  return shape;
}

Transform place_at(const Transform& to_world, std::span<const Transform> moments, float time) {
  if (moments.empty()) return to_world;
  const auto [first, part] = moments_around(time, moments.size());
  const Transform &from = moments[first], &to = moments[first + 1];
  return {between(from.x, to.x, part), between(from.y, to.y, part), between(from.z, to.z, part),
          between(from.origin, to.origin, part)};
}

}  // namespace

void carry(const Transform& to_world, std::vector<Vec3f>& positions, std::vector<Vec3f>& normals,
           std::vector<Vec4f>& tangents) {
  const Transform inverse =
      to_world.inverse().value_or(Transform{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const float orientation = to_world.determinant() < 0 ? -1.f : 1.f;
  for (Vec3f& p : positions) p = to_world.point(p);
  for (Vec3f& n : normals) n = unit_or(inverse.transposed_vector(n), {0, 0, 0});
  for (Vec4f& t : tangents) {
    const Vec3f moved = unit_or(to_world.vector({t.x, t.y, t.z}), {1, 0, 0});
    t = {moved.x, moved.y, moved.z, t.w * orientation};
  }
}

std::vector<MeshShape> moments_in_world(const MeshDescription& mesh, const Transform& to_world,
                                        std::span<const Transform> moments) {
  std::vector<MeshShape> shapes(std::max(mesh.moments.size(), moments.size()));
  for (size_t i = 0; i < shapes.size(); ++i) {
    const float time = float(i) / float(shapes.size() - 1);
    shapes[i] = shape_at(mesh, time);
    carry(place_at(to_world, moments, time), shapes[i].positions, shapes[i].normals, shapes[i].tangents);
  }
  return shapes;
}

void check_moment_count(size_t count, const std::string& what) {
  if (count == 0 || (count >= 2 && count <= most_moments && std::has_single_bit(count - 1))) return;
  throw Error(
      ErrorKind::usage,
      fmt::format("{} has {} moments; expected 2, 3, 5 and so on to {}, one more than a power of two, "
                  "or none, if it stands still",
                  what, count, most_moments));
}

void check_moments(const MeshDescription& mesh, const InstanceDescription& instance) {
  if (mesh.moments.empty() && instance.moments.empty()) return;
  check_moment_count(mesh.moments.size(), fmt::format("the mesh '{}'", mesh.name));
  check_moment_count(instance.moments.size(), fmt::format("the instance '{}'", instance.name));
  for (const MeshShape& shape : mesh.moments)
    if (shape.positions.size() != mesh.positions.size() || shape.normals.size() != mesh.normals.size() ||
        shape.tangents.size() != mesh.tangents.size())
      throw Error(
          ErrorKind::usage,
          fmt::format("the mesh '{}' has moments with other numbers of positions, normals or tangents "
                      "than itself; expected the same",
                      mesh.name));
  for (const Transform& moment : instance.moments)
    if ((moment.determinant() < 0) != (instance.to_world.determinant() < 0))
      throw Error(
          ErrorKind::usage,
          fmt::format("the instance '{}' mirrors its mesh at some moments only, and so turns it inside "
                      "out; let it stand still",
                      instance.name));
}

}  // namespace vernier
