// SPDX-License-Identifier: Apache-2.0
#include "scene/import/deform.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/import/accessors.h"

namespace vernier {
namespace {

using Imath::M44d;

Vec3f unit_or(const Vec3f& v, const Vec3f& otherwise) {
  const float length2 = length_squared(v);
  return length2 > 1e-20f && std::isfinite(length2) ? v * (1 / std::sqrt(length2)) : otherwise;
}

void set_direction(Vec4f& tangent, const Vec3f& direction) {
  tangent = Vec4f(direction.x, direction.y, direction.z, tangent.w);
}

template <typename V>
void add_scaled(std::vector<V>& values, const std::vector<V>& deltas, float weight) {
  for (size_t i = 0; i < values.size() && i < deltas.size(); ++i) values[i] += deltas[i] * weight;
}

void clamp_colors(std::vector<Vec4f>& colors) {
  for (auto& color : colors)
    for (int c = 0; c < 4; ++c) color[c] = std::clamp(color[c], 0.f, 1.f);
}

/// Joints and weights of one vertex: sets of four (JOINTS_0, JOINTS_1, ...).
struct Influences {
  std::vector<std::vector<Vec4f>> joints, weights;

  Influences(const PrimitiveData& data, size_t joint_count) {
    for (int set = 0;; ++set) {
      const std::string joints_name = fmt::format("JOINTS_{}", set),
                        weights_name = fmt::format("WEIGHTS_{}", set);
      if (!data.has(joints_name) || !data.has(weights_name)) break;
      joints.push_back(data.read<Vec4f>(joints_name));
      weights.push_back(data.read<Vec4f>(weights_name));
      for (const auto& four : joints.back())
        for (int c = 0; c < 4; ++c)
          if (!(four[c] >= 0 && four[c] < float(joint_count)))
            data.fail("/attributes/" + joints_name,
                      fmt::format("joint {} of a skin of {}", four[c], joint_count));
    }
    if (joints.empty()) data.fail("/attributes", "a skinned mesh needs JOINTS_0 and WEIGHTS_0");
  }

  /// Weighted mean of the joints' matrices; the first joint's when there are no weights.
  M44d blend(size_t vertex, const std::vector<M44d>& matrices) const {
    M44d sum(0.0);
    double total = 0;
    for (size_t set = 0; set < joints.size(); ++set)
      for (int c = 0; c < 4; ++c) {
        const double weight = weights[set][vertex][c];
        if (!(weight > 0)) continue;
        sum += matrices[size_t(joints[set][vertex][c])] * weight;
        total += weight;
      }
    return total > 0 && std::isfinite(total) ? sum / total : matrices[size_t(joints[0][vertex][0])];
  }
};

/// n under the inverse transpose of the linear part, up to a positive factor: its cofactors, with the
/// determinant's sign.
Vec3d transformed_normal(const Vec3f& n, const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const Vec3d cofactors = cross(y, z) * double(n.x) + cross(z, x) * double(n.y) + cross(x, y) * double(n.z);
  return dot(x, cross(y, z)) < 0 ? -cofactors : cofactors;
}

}  // namespace

void morph(const PrimitiveData& data, const std::vector<double>& weights, const std::vector<int>& texcoords,
           MeshDescription& mesh) {
  const auto old_normals = mesh.normals;
  bool colors_change = false;
  for (size_t target = 0; target < weights.size() && target < data.target_count(); ++target) {
    const float weight = float(weights[target]);
    if (weight == 0) continue;
    add_scaled(mesh.positions, data.read_target<Vec3f>(target, "POSITION"), weight);
    if (!mesh.normals.empty()) add_scaled(mesh.normals, data.read_target<Vec3f>(target, "NORMAL"), weight);
    if (!mesh.tangents.empty()) {
      const auto deltas = data.read_target<Vec3f>(target, "TANGENT");
      for (size_t i = 0; i < deltas.size(); ++i)
        mesh.tangents[i] += Vec4f(deltas[i].x, deltas[i].y, deltas[i].z, 0) * weight;
    }
    for (size_t set = 0; set < mesh.texcoord_set_count(); ++set)
      if (!mesh.texcoord_set(set).empty())
        add_scaled(mesh.texcoord_set(set),
                   data.read_target<Vec2f>(target, fmt::format("TEXCOORD_{}", texcoords[set])), weight);
    const auto color_deltas = mesh.colors.empty() ? mesh.colors : data.read_target_colors(target);
    add_scaled(mesh.colors, color_deltas, weight);
    colors_change = colors_change || !color_deltas.empty();
  }
  if (colors_change) clamp_colors(mesh.colors);
  for (size_t i = 0; i < mesh.normals.size(); ++i) mesh.normals[i] = unit_or(mesh.normals[i], old_normals[i]);
  for (auto& t : mesh.tangents) set_direction(t, unit_or(Vec3f(t.x, t.y, t.z), Vec3f(1, 0, 0)));
}

std::vector<M44d> joint_matrices(const Document& document, int index,
                                 const std::vector<M44d>& node_to_world) {
  const auto& source = document.model().skins[size_t(index)];
  std::vector<M44d> matrices;
  for (const int joint : source.joints) matrices.push_back(node_to_world[size_t(joint)]);
  if (source.inverseBindMatrices < 0) return matrices;
  struct Columns {
    float values[16];
  };
  const auto inverse_binds = read_vectors<Columns>(document, source.inverseBindMatrices);
  if (inverse_binds.size() < matrices.size())
    document.fail(fmt::format("/skins/{}/inverseBindMatrices", index),
                  fmt::format("{} matrices for {} joints", inverse_binds.size(), matrices.size()));
  for (size_t i = 0; i < matrices.size(); ++i) {
    M44d inverse_bind;
    for (int e = 0; e < 16; ++e) inverse_bind[e / 4][e % 4] = double(inverse_binds[i].values[e]);
    matrices[i] = inverse_bind * matrices[i];
  }
  return matrices;
}

void skin(const PrimitiveData& data, const std::vector<M44d>& joints, MeshDescription& mesh) {
  const Influences influences(data, joints.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const M44d m = influences.blend(i, joints);
    const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    const Vec3f p = mesh.positions[i];
    mesh.positions[i] =
        Vec3f(x * double(p.x) + y * double(p.y) + z * double(p.z) + Vec3d(m[3][0], m[3][1], m[3][2]));
    if (!mesh.normals.empty())
      mesh.normals[i] = unit_or(Vec3f(transformed_normal(mesh.normals[i], x, y, z)), mesh.normals[i]);
    if (mesh.tangents.empty()) continue;
    Vec4f& t = mesh.tangents[i];
    const Vec3f direction(x * double(t.x) + y * double(t.y) + z * double(t.z));
    set_direction(t, unit_or(direction, Vec3f(t.x, t.y, t.z)));
  }
}

}  // namespace vernier
