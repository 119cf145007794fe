// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <random>
#include <string>
#include <vector>

#include "apps/validation/exact.h"
#include "scene/accel/accelerator.h"

// Geometry and random numbers for the hard cases.

namespace vernier::validation {

/// Random numbers that are the same on every platform.
class Rng {
 public:
  Rng(uint64_t seed, uint64_t stream) : engine_(seed * 0x9E3779B97F4A7C15u + stream) {}

  uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
  float uniform(float low, float high) { return low + (high - low) * (float(engine_() >> 40) * 0x1p-24f); }
  /// Uniform in the logarithm.
  float magnitude(float low, float high) { return std::exp(uniform(std::log(low), std::log(high))); }
  Vec3f in_cube(float half) {
    const float x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  Vec3f direction();

 private:
  std::mt19937_64 engine_;
};

/// Meshes and instances that own their arrays.
class TriangleSoup {
 public:
  TriangleSoup() = default;
  TriangleSoup(const TriangleSoup&) = delete;
  TriangleSoup& operator=(const TriangleSoup&) = delete;

  uint32_t add_mesh(std::vector<Vec3f> positions, std::vector<Triangle> triangles);
  /// Returns the instance's index.
  uint32_t add_instance(uint32_t mesh, const Transform& to_world = {}, bool filtered = false);
  /// A mesh in world space.
  void add(std::vector<Vec3f> positions, std::vector<Triangle> triangles) {
    add_instance(add_mesh(std::move(positions), std::move(triangles)));
  }

  /// A mesh in world space that moves: its positions at each moment.
  void add_moving(const std::vector<std::vector<Vec3f>>& moments, std::vector<Triangle> triangles);

  const Geometry& geometry() const { return geometry_; }
  void set_filter(const HitFilter* filter) { geometry_.filter = filter; }
  std::vector<Vec3f>& positions(uint32_t mesh) { return positions_[mesh]; }

  /// Of a triangle in the world; exact for instances without a transform.
  Corners corners(uint32_t instance, uint32_t primitive) const;

 private:
  std::deque<std::vector<Vec3f>> positions_;  ///< by mesh where none moves; stay where they are
  std::deque<std::vector<Triangle>> triangles_;
  Geometry geometry_;
};

/// Two triangles 0 1 2 and 2 1 3 that share the edge 1 2, slightly folded, in no particular place or
/// orientation, with their vertices in a random cyclic order; size about `size`, near `center`.
void add_folded_quad(TriangleSoup& soup, Rng& rng, float size, const Vec3f& center);

/// Six triangles around vertex 0, slightly folded.
void add_fan(TriangleSoup& soup, Rng& rng, float size, const Vec3f& center);

/// A closed star-shaped surface about `center` of 20 * 4^levels triangles with radii in [0.7, 1] times
/// `radius`, facing outward: rays from the center must hit it.
void add_blob(TriangleSoup& soup, Rng& rng, unsigned levels, float radius, const Vec3f& center);

/// n x n squares of two triangles each, wavy, over [-1, 1]^2.
void add_waves(TriangleSoup& soup, unsigned n);

/// `count` triangles with sides of about `size` in the cube [-1, 1]^3.
void add_random_triangles(TriangleSoup& soup, Rng& rng, uint32_t count, float size);

/// Rotation by a random angle about a random axis, stretched by `scale` before, moved by `origin`.
Transform random_placement(Rng& rng, const Vec3f& scale, const Vec3f& origin);

}  // namespace vernier::validation
