// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/soup.h"

#include <map>

#include "core/math/frame.h"

namespace vernier::validation {

Vec3f Rng::direction() {
  while (true) {
    const Vec3f v = in_cube(1);
    if (const float l2 = length_squared(v); l2 > 0.01f && l2 < 1) return normalize(v);
  }
}

uint32_t TriangleSoup::add_mesh(std::vector<Vec3f> positions, std::vector<Triangle> triangles) {
  const size_t count = positions.size();
  positions.resize(count + 2);  // GeometryMesh asks for readable bytes past the end
  positions_.push_back(std::move(positions));
  triangles_.push_back(std::move(triangles));
  geometry_.meshes.push_back({std::span(positions_.back()).first(count), triangles_.back()});
  return static_cast<uint32_t>(geometry_.meshes.size() - 1);
}

uint32_t TriangleSoup::add_instance(uint32_t mesh, const Transform& to_world, bool filtered) {
  geometry_.instances.push_back({mesh, to_world, filtered});
  return static_cast<uint32_t>(geometry_.instances.size() - 1);
}

void TriangleSoup::add_moving(const std::vector<std::vector<Vec3f>>& moments,
                              std::vector<Triangle> triangles) {
  const uint32_t mesh = add_mesh(moments[0], std::move(triangles));
  for (const auto& positions : moments) {
    positions_.push_back(positions);
    positions_.back().resize(positions.size() + 2);
    geometry_.meshes[mesh].moments.push_back(std::span(positions_.back()).first(positions.size()));
  }
  add_instance(mesh);
}

Corners TriangleSoup::corners(uint32_t instance, uint32_t primitive) const {
  const GeometryInstance& placed = geometry_.instances[instance];
  const GeometryMesh& mesh = geometry_.meshes[placed.mesh];
  const Triangle& triangle = mesh.triangles[primitive];
  Corners corners;
  for (size_t i = 0; i < 3; ++i) {
    corners[i] = mesh.positions[triangle[i]];
    if (!placed.to_world.is_identity()) corners[i] = placed.to_world.point(corners[i]);
  }
  return corners;
}

namespace {

void rotate_corners(Triangle& triangle, Rng& rng) {
  std::rotate(triangle.begin(), triangle.begin() + rng.below(3), triangle.end());
}

}  // namespace

void add_folded_quad(TriangleSoup& soup, Rng& rng, float size, const Vec3f& center) {
  const Frame frame = Frame::from_normal(rng.direction());
  const auto place = [&](float x, float y, float z) {
    return center + size * (frame.x * (x + rng.uniform(-.2f, .2f)) + frame.y * (y + rng.uniform(-.2f, .2f)) +
                            frame.z * (z + rng.uniform(-.1f, .1f)));
  };
  std::vector<Vec3f> positions{place(0, 0, 0), place(1, 0, 0), place(0, 1, 0), place(1, 1, 0)};
  std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 3}};
  for (Triangle& triangle : triangles) rotate_corners(triangle, rng);
  soup.add(std::move(positions), std::move(triangles));
}

void add_fan(TriangleSoup& soup, Rng& rng, float size, const Vec3f& center) {
  const Frame frame = Frame::from_normal(rng.direction());
  std::vector<Vec3f> positions{center};
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < 6; ++i) {
    const float angle = (float(i) + rng.uniform(-.3f, .3f)) * (2 * pi / 6),
                radius = size * rng.uniform(.5f, 1);
    positions.push_back(center + frame.x * (radius * std::cos(angle)) + frame.y * (radius * std::sin(angle)) +
                        frame.z * (size * rng.uniform(-.1f, .1f)));
    triangles.push_back({0, i + 1, (i + 1) % 6 + 1});
    rotate_corners(triangles.back(), rng);
  }
  soup.add(std::move(positions), std::move(triangles));
}

void add_blob(TriangleSoup& soup, Rng& rng, unsigned levels, float radius, const Vec3f& center) {
  const float a = 0.525731112f, b = 0.850650808f;  // icosahedron
  std::vector<Vec3f> directions{{-a, b, 0},  {a, b, 0},  {-a, -b, 0}, {a, -b, 0}, {0, -a, b},  {0, a, b},
                                {0, -a, -b}, {0, a, -b}, {b, 0, -a},  {b, 0, a},  {-b, 0, -a}, {-b, 0, a}};
  std::vector<Triangle> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                  {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                  {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                  {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (unsigned level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t i, uint32_t j) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(i, j), static_cast<uint32_t>(directions.size()));
      if (is_new) directions.push_back(normalize(directions[i] + directions[j]));
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [i, j, k] : triangles) {
      const uint32_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
      finer.insert(finer.end(), {{i, ij, ki}, {j, jk, ij}, {k, ki, jk}, {ij, jk, ki}});
    }
    triangles = std::move(finer);
  }
  std::vector<Vec3f> positions;
  positions.reserve(directions.size());
  for (const Vec3f& direction : directions)
    positions.push_back(center + direction * (radius * rng.uniform(.7f, 1)));
  for (Triangle& triangle : triangles) rotate_corners(triangle, rng);
  soup.add(std::move(positions), std::move(triangles));
}

void add_waves(TriangleSoup& soup, unsigned n) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (unsigned j = 0; j <= n; ++j)
    for (unsigned i = 0; i <= n; ++i) {
      const float x = 2 * float(i) / float(n) - 1, y = 2 * float(j) / float(n) - 1;
      positions.emplace_back(x, y, 0.1f * std::sin(7 * x) * std::cos(5 * y));
    }
  for (unsigned j = 0; j < n; ++j)
    for (unsigned i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i, b = a + n + 1;
      triangles.insert(triangles.end(), {{a, a + 1, b}, {a + 1, b + 1, b}});
    }
  soup.add(std::move(positions), std::move(triangles));
}

void add_random_triangles(TriangleSoup& soup, Rng& rng, uint32_t count, float size) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (uint32_t i = 0; i < count; ++i) {
    const Vec3f center = rng.in_cube(1);
    for (int k = 0; k < 3; ++k) positions.push_back(center + rng.in_cube(size));
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  soup.add(std::move(positions), std::move(triangles));
}

Transform random_placement(Rng& rng, const Vec3f& scale, const Vec3f& origin) {
  const Vec3f axis = rng.direction();
  const Frame frame = Frame::from_normal_tangent(axis, rng.direction());
  return {frame.x * scale.x, frame.y * scale.y, frame.z * scale.z, origin};
}

}  // namespace vernier::validation
