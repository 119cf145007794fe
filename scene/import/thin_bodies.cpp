// SPDX-License-Identifier: Apache-2.0
#include "scene/import/thin_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/math/frame.h"
#include "scene/import/vertex_arrays.h"

namespace vernier {
namespace {

// Beyond so many points or lines in a scene each gets the least body there is.
constexpr size_t many = 100'000;

/// Vertices relative to a point, and triangles of them.
struct Polyhedron {
  std::vector<Vec3f> vertices;
  std::vector<Triangle> triangles;
};

/// A convex body shows a quarter of its surface on average (Cauchy): a sphere of radius 1 pi, an octahedron
/// of circumradius R sqrt(3) R^2, a tetrahedron 2 R^2 / sqrt(3).
Polyhedron point_body(float radius, bool least) {
  if (least) {
    const float a = radius * float(std::sqrt(std::numbers::pi / (2 * std::numbers::sqrt3)));
    return {{{a, a, a}, {-a, -a, a}, {-a, a, -a}, {a, -a, -a}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  }
  const float a = radius * float(std::sqrt(std::numbers::pi / std::numbers::sqrt3));
  return {{{a, 0, 0}, {0, a, 0}, {0, 0, a}, {-a, 0, 0}, {0, -a, 0}, {0, 0, -a}},
          {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}}};
}

/// A hexagon of the area of a circle.
Polyhedron disc_body(float radius, const Vec3f& normal) {
  const float a = radius * float(std::sqrt(2 * std::numbers::pi / (3 * std::numbers::sqrt3)));
  const Frame frame = Frame::from_normal(normal);
  Polyhedron body{{}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}};
  for (int i = 0; i < 6; ++i) {
    const float angle = float(i) * float(std::numbers::pi / 3);
    body.vertices.push_back((frame.x * std::cos(angle) + frame.y * std::sin(angle)) * a);
  }
  return body;
}

/// A mesh of bodies that takes the place of one of points or lines.
class BodyMesh {
 public:
  BodyMesh(MeshDescription& mesh, float radius, bool least) : mesh_(mesh), radius_(radius), least_(least) {}

  void replace(bool points, bool lit) {
    elements_ = std::move(mesh_.triangles);
    mesh_.triangles.clear();
    if (points)
      add_points();
    else
      add_lines(lit);
    gather_vertices(mesh_, sources_);
    for (size_t i = 0; i < offsets_.size(); ++i) mesh_.positions[i] += offsets_[i];
    if (!points) mesh_.normals = std::move(normals_);
  }

  /// Each gets up to ten vertices.
  static constexpr size_t most_elements = std::numeric_limits<uint32_t>::max() / 10;

 private:
  void add_points() {
    const bool discs = !mesh_.normals.empty();
    Polyhedron body = discs ? disc_body(radius_, Vec3f(0, 0, 1)) : point_body(radius_, least_);
    reserve(body.vertices.size(), body.triangles.size());
    for (const Triangle& element : elements_) {
      const uint32_t first = uint32_t(sources_.size());
      if (discs) body = disc_body(radius_, mesh_.normals[element[0]]);
      for (const Vec3f& v : body.vertices) add_vertex(element[0], v);
      for (const Triangle& t : body.triangles)
        mesh_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }

  /// A prism of n sides around each line, with points beyond its ends that close the gaps between lines at an
  /// angle, unless there are too many for anybody to see; a rod of radius 1 is as wide on average as a prism
  /// whose perimeter is 2 pi.
  void add_lines(bool lit) {
    const uint32_t sides = least_ ? 3 : 4;
    const float turn = 2 * float(std::numbers::pi) / float(sides);
    const float across = radius_ * float(std::numbers::pi) / (float(sides) * std::sin(turn / 2));
    reserve(2 * sides + (least_ ? 0 : 2), (least_ ? 2 : 4) * sides);
    for (const Triangle& element : elements_) {
      const Vec3d step = Vec3d(mesh_.positions[element[1]]) - Vec3d(mesh_.positions[element[0]]);
      const Vec3f along = length_squared(step) > 0 ? Vec3f(normalize(step)) : Vec3f(1, 0, 0);
      const Frame frame = Frame::from_normal(along);
      const uint32_t first = uint32_t(sources_.size());
      for (uint32_t side = 0; side < sides; ++side) {
        const float angle = float(side) * turn;
        const Vec3f out = frame.x * std::cos(angle) + frame.y * std::sin(angle);
        for (const int end : {0, 1}) {
          add_vertex(element[size_t(end)], out * across);
          if (lit) normals_.push_back(out);
        }
      }
      add_walls(first, sides);
      if (least_) continue;
      for (const int end : {0, 1}) {
        const Vec3f out = end ? along : -along;
        add_vertex(element[size_t(end)], out * radius_);
        if (lit) normals_.push_back(out);
      }
      add_ends(first, sides);
    }
  }

  // Vertices of a prism: of each side the one at the start and the one at the end, then both points.
  void add_walls(uint32_t first, uint32_t sides) {
    for (uint32_t side = 0; side < sides; ++side) {
      const uint32_t a = first + 2 * side, b = first + 2 * ((side + 1) % sides);
      mesh_.triangles.push_back({a, b, b + 1});
      mesh_.triangles.push_back({a, b + 1, a + 1});
    }
  }
  void add_ends(uint32_t first, uint32_t sides) {
    const uint32_t start = first + 2 * sides, end = start + 1;
    for (uint32_t side = 0; side < sides; ++side) {
      const uint32_t a = first + 2 * side, b = first + 2 * ((side + 1) % sides);
      mesh_.triangles.push_back({b, a, start});
      mesh_.triangles.push_back({a + 1, b + 1, end});
    }
  }

  void add_vertex(uint32_t source, const Vec3f& offset) {
    sources_.push_back(source);
    offsets_.push_back(offset);
  }
  void reserve(size_t vertices, size_t triangles) {
    sources_.reserve(elements_.size() * vertices);
    offsets_.reserve(elements_.size() * vertices);
    mesh_.triangles.reserve(elements_.size() * triangles);
  }

  MeshDescription& mesh_;
  float radius_;
  bool least_;
  std::vector<Triangle> elements_;
  std::vector<uint32_t> sources_;
  std::vector<Vec3f> offsets_, normals_;
};

/// Number and extent of all points, or all lines, in the world.
struct ThinElements {
  size_t count = 0;
  double positions = 0;
  Vec3d origin{0, 0, 0};  ///< one of them, from which the others are measured
  Vec3d sum{0, 0, 0}, squares{0, 0, 0};

  void add(const MeshDescription& mesh, const Transform& to_world) {
    if (count == 0) origin = Vec3d(to_world.point(mesh.positions[0]));
    count += mesh.triangles.size();
    positions += double(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) {
      const Vec3d place = Vec3d(to_world.point(p)) - origin;
      sum += place;
      squares += place * place;
    }
  }

  /// Diagonal of a box that they would fill evenly: unlike that of their bounds it hardly changes with a
  /// stray one.
  double size() const {
    if (count == 0) return 0;
    const Vec3d mean = sum / positions;
    const Vec3d variance = squares / positions - mean * mean;
    return std::sqrt(12 * std::max(variance.x + variance.y + variance.z, 0.0));
  }
};

/// Factor by which lengths grow on average; 1 when it cannot be told.
double scale_of(const Transform& t) {
  const double scale = std::cbrt(std::abs(t.determinant()));
  return scale > 0 && std::isfinite(scale) ? scale : 1;
}

}  // namespace

void make_thin(MaterialDescription& m, bool lit) {
  m.double_sided = true;
  m.normal_texture = {};
  m.clearcoat_normal_texture = {};
  m.anisotropy = 0;
  m.transmission = 0;
  m.thickness = 0;
  if (lit || m.unlit) return;
  m.unlit = true;
  if (m.base_color.x == 0 && m.base_color.y == 0 && m.base_color.z == 0)
    m.base_color_texture = m.emissive_texture;
  for (int c = 0; c < 3; ++c) m.base_color[c] += m.emissive[c];
  m.emissive = Rgb(0, 0, 0);
  m.emissive_texture = {};
}

void add_thin_bodies(const Document& document, const std::vector<MeshRequest>& requests,
                     SceneDescription& scene) {
  ThinElements points, lines;
  std::vector<double> scales(requests.size(), 0);
  for (const auto& instance : scene.instances) {
    const Topology topology = requests[instance.mesh].topology;
    if (topology == Topology::triangles) continue;
    (topology == Topology::points ? points : lines).add(scene.meshes[instance.mesh], instance.to_world);
    if (scales[instance.mesh] == 0) scales[instance.mesh] = scale_of(instance.to_world);
  }
  const size_t count = points.count + lines.count;
  if (count == 0) return;
  for (size_t i = 0; i < requests.size(); ++i)
    if (const size_t own = scene.meshes[i].triangles.size();
        requests[i].topology != Topology::triangles && own > BodyMesh::most_elements)
      document.fail(fmt::format("/meshes/{}", requests[i].use.mesh),
                    fmt::format("{} points or lines; at most {} can be read", own, BodyMesh::most_elements));
  // As fine as a raster of their number, but no coarser than a few pixels of a picture that they fill.
  const double size = std::max(points.size(), lines.size()) > 0 ? std::max(points.size(), lines.size()) : 1;
  const double point_radius = size * std::min(1.0 / 250, 0.5 / std::sqrt(double(points.count)));
  const double line_radius = size / 1000;
  parallel_for(requests.size(), [&](size_t i) {
    const MeshRequest& request = requests[i];
    if (request.topology == Topology::triangles) return;
    const bool of_points = request.topology == Topology::points;
    const double radius = (of_points ? point_radius : line_radius) / scales[i];
    const bool lit = !scene.meshes[i].normals.empty();
    BodyMesh(scene.meshes[i], float(radius), count > many).replace(of_points, lit);
  });
}

}  // namespace vernier
