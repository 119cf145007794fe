// SPDX-License-Identifier: Apache-2.0
#include "scene/import/tangents.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "core/math/frame.h"
#include "scene/import/vertex_arrays.h"

namespace vernier {
namespace {

constexpr int none = -1;

/// The mesh as its corners: three a triangle.
struct Corner {
  uint32_t triangle, corner;
};

/// What MikkTSpace keeps of a triangle.
struct TriangleInfo {
  Vec3f s{0, 0, 0};                       ///< direction of increasing u, unit
  bool mirrored = false;                  ///< texture coordinates wind against the triangle
  bool joins_any = true;                  ///< no direction of its own: takes the side of whoever comes first
  bool degenerate = false;                ///< no area: left out
  int neighbour[3] = {none, none, none};  ///< across the edge from corner i to the next
  int group[3] = {none, none, none};
};

/// Triangles around one welded vertex that share a tangent.
struct Group {
  bool mirrored = false;
  Vec3d sum{0, 0, 0};
};

bool not_zero(float v) { return std::abs(v) > std::numeric_limits<float>::min(); }

Vec3f projected(const Vec3f& v, const Vec3f& n) {
  const Vec3f in_plane = v - n * dot(n, v);
  const float length2 = length_squared(in_plane);
  return length2 > 0 ? in_plane * (1 / std::sqrt(length2)) : in_plane;
}

class TangentBuilder {
 public:
  TangentBuilder(MeshDescription& mesh, const TextureUse& map)
      : mesh_(mesh),
        uv_(transformed(mesh.texcoord_set(size_t(map.texcoord)), map)),
        info_(mesh.triangles.size()) {}

  void build() {
    weld();
    for (size_t t = 0; t < info_.size(); ++t) describe_triangle(t);
    link_neighbours();
    for (uint32_t t = 0; t < info_.size(); ++t)
      for (uint32_t c = 0; c < 3; ++c)
        if (!info_[t].degenerate && !info_[t].joins_any && info_[t].group[c] == none) grow_group({t, c});
    accumulate();
    assign();
  }

 private:
  /// Texture coordinates as the map is read: only its rotation and the signs of its scale matter for
  /// directions.
  static std::vector<Vec2f> transformed(std::vector<Vec2f> uv, const TextureUse& map) {
    const float c = std::cos(map.rotation), s = std::sin(map.rotation);
    for (auto& p : uv) {
      const Vec2f scaled = p * map.scale;
      p = Vec2f(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
    }
    return uv;
  }

  /// Numbers vertices so that those of equal position, normal and texture coordinates have one number.
  void weld() {
    struct Key {
      float v[8];
      bool operator==(const Key&) const = default;
    };
    struct Hash {
      size_t operator()(const Key& key) const {
        uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a over words
        for (const float f : key.v) {
          uint32_t bits;
          std::memcpy(&bits, &f, sizeof(bits));
          hash = (hash ^ bits) * 0x100000001b3u;
          hash ^= hash >> 29;
        }
        return hash;
      }
    };
    std::unordered_map<Key, uint32_t, Hash> numbers(mesh_.positions.size());
    welded_.resize(mesh_.positions.size());
    for (size_t i = 0; i < welded_.size(); ++i) {
      const Vec3f &p = mesh_.positions[i], &n = mesh_.normals[i];
      Key key{{p.x, p.y, p.z, n.x, n.y, n.z, uv_[i].x, uv_[i].y}};
      for (float& f : key.v) f += 0.f;  // -0 becomes 0
      welded_[i] = numbers.try_emplace(key, uint32_t(i)).first->second;
    }
  }

  void describe_triangle(size_t t) {
    const Triangle& v = mesh_.triangles[t];
    TriangleInfo& info = info_[t];
    const Vec3f &p0 = mesh_.positions[v[0]], &p1 = mesh_.positions[v[1]], &p2 = mesh_.positions[v[2]];
    info.degenerate = p0 == p1 || p1 == p2 || p2 == p0;
    const Vec2f a = uv_[v[1]] - uv_[v[0]], b = uv_[v[2]] - uv_[v[0]];
    const float area = a.x * b.y - a.y * b.x;
    info.mirrored = !(area > 0);
    if (!not_zero(area)) return;
    const Vec3f s = (p1 - p0) * b.y - (p2 - p0) * a.y, up = (p2 - p0) * a.x - (p1 - p0) * b.x;
    const float s_length = length(s), up_length = length(up);
    if (not_zero(s_length)) info.s = s * ((info.mirrored ? -1 : 1) / s_length);
    info.joins_any = !not_zero(s_length / std::abs(area)) || !not_zero(up_length / std::abs(area));
  }

  uint32_t vertex(uint32_t triangle, uint32_t corner) const {
    return welded_[mesh_.triangles[triangle][corner % 3]];
  }

  /// Joins triangles across edges that two of them run along in opposite directions.
  void link_neighbours() {
    struct Edge {
      uint32_t low, high, triangle, corner;
      bool operator<(const Edge& o) const {
        return std::tie(low, high, triangle, corner) < std::tie(o.low, o.high, o.triangle, o.corner);
      }
    };
    std::vector<Edge> edges;
    edges.reserve(info_.size() * 3);
    for (uint32_t t = 0; t < info_.size(); ++t)
      for (uint32_t c = 0; c < 3 && !info_[t].degenerate; ++c) {
        const uint32_t from = vertex(t, c), to = vertex(t, c + 1);
        edges.push_back({std::min(from, to), std::max(from, to), t, c});
      }
    std::sort(edges.begin(), edges.end());
    for (size_t i = 0; i < edges.size(); ++i)
      for (size_t j = i + 1;
           j < edges.size() && edges[j].low == edges[i].low && edges[j].high == edges[i].high; ++j) {
        int& mine = info_[edges[i].triangle].neighbour[edges[i].corner];
        int& other = info_[edges[j].triangle].neighbour[edges[j].corner];
        const bool opposite =
            vertex(edges[i].triangle, edges[i].corner) != vertex(edges[j].triangle, edges[j].corner);
        if (mine != none) break;
        if (other != none || !opposite) continue;
        mine = int(edges[j].triangle);
        other = int(edges[i].triangle);
      }
  }

  /// Collects the triangles around a corner's vertex that are joined to it by edges and wind the same way.
  void grow_group(Corner seed) {
    const int group = int(groups_.size());
    groups_.push_back({info_[seed.triangle].mirrored, Vec3d(0, 0, 0)});
    const uint32_t centre = vertex(seed.triangle, seed.corner);
    std::vector<int> pending{int(seed.triangle)};
    while (!pending.empty()) {
      const uint32_t t = uint32_t(pending.back());
      pending.pop_back();
      TriangleInfo& info = info_[t];
      const uint32_t c = vertex(t, 0) == centre ? 0 : vertex(t, 1) == centre ? 1 : 2;
      if (info.group[c] != none) continue;
      if (info.joins_any && info.group[0] == none && info.group[1] == none && info.group[2] == none)
        info.mirrored = groups_[size_t(group)].mirrored;
      if (info.mirrored != groups_[size_t(group)].mirrored) continue;
      info.group[c] = group;
      for (const int next : {info.neighbour[(c + 2) % 3], info.neighbour[c]})
        if (next != none) pending.push_back(next);
    }
  }

  /// Adds each triangle's direction to its groups, weighted by its angle at the vertex.
  void accumulate() {
    for (size_t t = 0; t < info_.size(); ++t) {
      const TriangleInfo& info = info_[t];
      const Triangle& v = mesh_.triangles[t];
      if (info.joins_any) continue;
      for (size_t c = 0; c < 3; ++c) {
        if (info.group[c] == none) continue;
        const Vec3f n = mesh_.normals[v[c]], p = mesh_.positions[v[c]];
        const Vec3f to_next = projected(mesh_.positions[v[(c + 1) % 3]] - p, n);
        const Vec3f to_last = projected(mesh_.positions[v[(c + 2) % 3]] - p, n);
        const float angle = std::acos(std::clamp(dot(to_next, to_last), -1.f, 1.f));
        groups_[size_t(info.group[c])].sum += Vec3d(projected(info.s, n)) * double(angle);
      }
    }
  }

  Vec4f tangent_of(int group, const Vec3f& n) const {
    if (group == none || !(length_squared(groups_[size_t(group)].sum) > 0)) {
      const Vec3f any = Frame::from_normal(n).x;
      return {any.x, any.y, any.z, 1};
    }
    const Vec3f s(normalize(groups_[size_t(group)].sum));
    // MikkTSpace has v point up: glTF's handedness is the opposite of its.
    return {s.x, s.y, s.z, groups_[size_t(group)].mirrored ? 1.f : -1.f};
  }

  /// Gives each vertex the tangent of its corners' group, splitting it where there are several.
  void assign() {
    std::vector<uint32_t> sources(mesh_.positions.size());
    std::iota(sources.begin(), sources.end(), 0u);
    std::vector<int> groups(sources.size(), none);
    std::unordered_map<uint64_t, uint32_t> copies;
    for (size_t t = 0; t < info_.size(); ++t)
      for (size_t c = 0; c < 3; ++c) {
        uint32_t& index = mesh_.triangles[t][c];
        const int group = info_[t].group[c];
        if (groups[index] == none) groups[index] = group;
        if (group == none || groups[index] == group) continue;
        const uint64_t key = uint64_t(index) << 32 | uint32_t(group);
        const auto [copy, is_new] = copies.try_emplace(key, uint32_t(sources.size()));
        if (is_new) {
          sources.push_back(index);
          groups.push_back(group);
        }
        index = copy->second;
      }
    if (!copies.empty()) gather_vertices(mesh_, sources);
    mesh_.tangents.reserve(groups.size());
    for (size_t i = 0; i < groups.size(); ++i)
      mesh_.tangents.push_back(tangent_of(groups[i], mesh_.normals[i]));
  }

  MeshDescription& mesh_;
  std::vector<Vec2f> uv_;
  std::vector<TriangleInfo> info_;
  std::vector<uint32_t> welded_;
  std::vector<Group> groups_;
};

/// Gives each triangle vertices of its own with its own normal.
void make_flat(MeshDescription& mesh) {
  unshare_vertices(mesh);
  mesh.normals.reserve(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const Vec3d p0(mesh.positions[triangle[0]]), p1(mesh.positions[triangle[1]]),
        p2(mesh.positions[triangle[2]]);
    const Vec3d area = cross(p1 - p0, p2 - p0);
    const Vec3f n = length_squared(area) > 0 ? Vec3f(normalize(area)) : Vec3f(0, 0, 1);
    mesh.normals.insert(mesh.normals.end(), 3, n);
  }
}

}  // namespace

void derive_tangents(MeshDescription& mesh, const TextureUse& map) {
  if (mesh.normals.empty()) make_flat(mesh);
  TangentBuilder(mesh, map).build();
}

}  // namespace vernier
