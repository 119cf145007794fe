// SPDX-License-Identifier: Apache-2.0
#include "scene/import/meshes.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/import/deform.h"
#include "scene/import/ordered_parallel.h"
#include "scene/import/tangents.h"
#include "scene/import/vertex_arrays.h"

namespace vernier {
namespace {

void check_positions(const PrimitiveData& data, const std::vector<Vec3f>& positions) {
  for (size_t i = 0; i < positions.size(); ++i)
    if (!is_finite(positions[i]))
      data.fail("/attributes/POSITION", fmt::format("position {} is not finite: ({}, {}, {})", i,
                                                    positions[i].x, positions[i].y, positions[i].z));
}

/// Per vertex, the unit mean of the normals of its triangles weighted by their areas. Where no triangle has
/// area no ray ever asks for the normal, so any unit vector does.
std::vector<Vec3f> triangle_normals(const MeshDescription& mesh) {
  std::vector<Vec3d> sums(mesh.positions.size(), Vec3d(0, 0, 0));
  for (const auto& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    const Vec3d area = cross(b - a, c - a);
    for (const uint32_t vertex : t) sums[vertex] += area;
  }
  std::vector<Vec3f> normals;
  normals.reserve(sums.size());
  for (const auto& sum : sums)
    normals.push_back(length_squared(sum) > 0 ? Vec3f(normalize(sum)) : Vec3f(0, 0, 1));
  return normals;
}

void repair_normals(MeshDescription& mesh, MeshRepairs& repairs) {
  std::vector<uint32_t> degenerate;
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    Vec3f& n = mesh.normals[i];
    const float length2 = length_squared(n);
    if (!(length2 > 1e-12f) || !std::isfinite(length2)) {
      degenerate.push_back(uint32_t(i));
      continue;
    }
    // Eight-bit normals are off by up to a hundredth.
    if (std::abs(length2 - 1) > 0.03f) ++repairs.normals_scaled;
    n *= 1 / std::sqrt(length2);
  }
  if (degenerate.empty()) return;
  repairs.normals_replaced += degenerate.size();
  const std::vector<Vec3f> replacements = triangle_normals(mesh);
  for (const uint32_t vertex : degenerate) mesh.normals[vertex] = replacements[vertex];
}

/// Tangents are used only when every one of them is.
void repair_tangents(MeshDescription& mesh, MeshRepairs& repairs) {
  for (auto& t : mesh.tangents) {
    const Vec3f direction(t.x, t.y, t.z);
    const float length2 = length_squared(direction);
    if (!(length2 > 1e-12f) || !std::isfinite(length2) || !std::isfinite(t.w)) {
      ++repairs.tangents_dropped;
      mesh.tangents.clear();
      return;
    }
    const float scale = 1 / std::sqrt(length2);
    t = Vec4f(t.x * scale, t.y * scale, t.z * scale, t.w < 0 ? -1.f : 1.f);
  }
}

void read_texcoords(const PrimitiveData& data, const MeshRequest& request, MeshDescription& mesh,
                    MeshRepairs& repairs) {
  mesh.more_texcoords.resize(request.texcoords.size() - mesh.texcoords.size());
  for (size_t set = 0; set < request.texcoords.size(); ++set) {
    if (request.texcoords[set] < 0) continue;
    const std::string attribute = fmt::format("TEXCOORD_{}", request.texcoords[set]);
    auto& texcoords = mesh.texcoord_set(set);
    if (!data.has(attribute)) {
      texcoords.assign(mesh.positions.size(), Vec2f(0, 0));
      ++repairs.texcoords_missing;
      continue;
    }
    texcoords = data.read<Vec2f>(attribute);
    for (auto& uv : texcoords)
      if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
        uv = Vec2f(0, 0);
        ++repairs.texcoords_zeroed;
      }
  }
}

/// Vertex colours that are finite and not negative; none when all are white.
void tidy_colors(std::vector<Vec4f>& colors) {
  bool white = true;
  for (auto& color : colors) {
    for (int c = 0; c < 4; ++c)
      if (!(color[c] >= 0) || !std::isfinite(color[c])) color[c] = 0;
    white = white && color == Vec4f(1, 1, 1, 1);
  }
  if (white) colors.clear();
}

MeshDescription read_mesh(const Document& document, const MeshRequest& request,
                          const std::vector<Imath::M44d>& node_to_world, MeshRepairs& repairs) {
  const MeshUse& use = request.use;
  const PrimitiveData data(document, use.mesh, use.primitive);
  MeshDescription mesh;
  mesh.name = document.model().meshes[size_t(use.mesh)].name;
  mesh.positions = data.read<Vec3f>("POSITION");
  check_positions(data, mesh.positions);
  mesh.triangles = request.topology == Topology::triangles ? data.read_triangles() : data.read_thin();
  if (data.has("NORMAL")) {
    mesh.normals = data.read<Vec3f>("NORMAL");
    repair_normals(mesh, repairs);
    // Without normals a file's tangents are to be ignored (glTF 2.0, 3.7.2.1).
    if (request.tangent_map && data.has("TANGENT")) {
      mesh.tangents = data.read<Vec4f>("TANGENT");
      repair_tangents(mesh, repairs);
    }
  }
  read_texcoords(data, request, mesh, repairs);
  if (data.has("COLOR_0")) mesh.colors = data.read_colors();
  if (!use.weights.empty()) morph(data, use.weights, request.texcoords, mesh);
  tidy_colors(mesh.colors);
  if (use.skin >= 0) skin(data, joint_matrices(document, use.skin, node_to_world), mesh);
  if (!use.weights.empty() || use.skin >= 0) check_positions(data, mesh.positions);
  drop_unused_vertices(mesh);
  if (request.tangent_map && mesh.tangents.empty()) derive_tangents(mesh, *request.tangent_map);
  return mesh;
}

/// Whether tangents that follow one texture follow the other as well.
bool same_axes(const std::optional<TextureUse>& a, const std::optional<TextureUse>& b) {
  if (!a || !b) return !a && !b;
  return a->texcoord == b->texcoord && a->offset == b->offset && a->scale == b->scale &&
         a->rotation == b->rotation;
}

}  // namespace

bool reads_the_same(const MeshRequest& a, const MeshRequest& b) {
  return a.texcoords == b.texcoords && same_axes(a.tangent_map, b.tangent_map);
}

void MeshRepairs::add(const MeshRepairs& other) {
  normals_scaled += other.normals_scaled;
  normals_replaced += other.normals_replaced;
  tangents_dropped += other.tangents_dropped;
  texcoords_zeroed += other.texcoords_zeroed;
  texcoords_missing += other.texcoords_missing;
}

std::vector<Notice> MeshRepairs::notices() const {
  std::vector<Notice> list;
  const auto add_if = [&](size_t count, const char* text) {
    if (count) list.push_back({Notice::Severity::warning, "/meshes", fmt::format(fmt::runtime(text), count)});
  };
  add_if(normals_scaled, "{} vertex normals were not of unit length and were scaled");
  add_if(normals_replaced,
         "{} vertex normals were zero or not finite and were replaced by those of their triangles");
  add_if(tangents_dropped, "{} primitives have zero or non-finite tangents; theirs are derived instead");
  add_if(texcoords_zeroed, "{} texture coordinates were not finite and were set to 0");
  add_if(texcoords_missing, "{} primitives lack texture coordinates that their material reads; 0 is used");
  return list;
}

std::shared_ptr<MeshCache::Entry> MeshCache::find(const MeshRequest& request) const {
  const auto found = entries_.find(request.use);
  return found != entries_.end() && reads_the_same(found->second->request, request) ? found->second : nullptr;
}

void MeshCache::replace(const std::vector<std::shared_ptr<Entry>>& entries) {
  entries_.clear();
  for (const auto& entry : entries)
    if (entry->request.use.skin < 0) entries_.emplace(entry->request.use, entry);
}

std::vector<MeshDescription> read_meshes(const Document& document, const std::vector<MeshRequest>& requests,
                                         const std::vector<Imath::M44d>& node_to_world, MeshRepairs& repairs,
                                         MeshCache* cache) {
  std::vector<std::shared_ptr<MeshCache::Entry>> entries(requests.size());
  std::vector<MeshDescription> meshes(requests.size());
  for_each_in_parallel(requests.size(), [&](size_t i) {
    if (cache) entries[i] = cache->find(requests[i]);
    if (!entries[i]) {
      entries[i] = std::make_shared<MeshCache::Entry>();
      entries[i]->request = requests[i];
      entries[i]->mesh = read_mesh(document, requests[i], node_to_world, entries[i]->repairs);
    }
    if (cache)
      meshes[i] = entries[i]->mesh;
    else
      meshes[i] = std::move(entries[i]->mesh);
  });
  for (const auto& entry : entries) repairs.add(entry->repairs);
  if (cache) cache->replace(entries);
  return meshes;
}

}  // namespace vernier
