#include "scene/closed_surface.h"

#include <bit>

namespace vernier {
namespace {

/// Finalizer of SplitMix64 (Steele, Lea, Flood 2014), a bijection that spreads each bit over all.
uint64_t mixed(uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

/// The same for equal positions; adding 0 makes -0 one of them.
uint64_t hash(const Vec3f& p) {
  uint64_t h = 0x9e3779b97f4a7c15;
  for (int axis = 0; axis < 3; ++axis) h = mixed(h + std::bit_cast<uint32_t>(p[axis] + 0.f));
  return h;
}

/// Of an edge, whichever end comes first. Nought when it has no length.
uint64_t edge_hash(uint64_t a, uint64_t b) { return a == b ? 0 : mixed(a + b) ^ mixed(mixed(a) + mixed(b)); }

}  // namespace

bool is_closed_surface(std::span<const MeshDescription* const> meshes) {
  // What is there an even number of times cancels.
  uint64_t odd_edges = 0;
  for (const MeshDescription* mesh : meshes)
    for (const Triangle& t : mesh->triangles) {
      const uint64_t a = hash(mesh->positions[t[0]]), b = hash(mesh->positions[t[1]]),
                     c = hash(mesh->positions[t[2]]);
      odd_edges ^= edge_hash(a, b) ^ edge_hash(b, c) ^ edge_hash(c, a);
    }
  return odd_edges == 0;
}

}  // namespace vernier
