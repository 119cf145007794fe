#include "scene/accel/instance.h"

#include <algorithm>
#include <tuple>

namespace vernier {

bool is_invertible(const Transform& to_world) {
  const auto inverse = to_world.inverse();
  if (!inverse) return false;
  for (const Transform* t : {&to_world, &*inverse})
    for (const Vec3f& column : {t->x, t->y, t->z, t->origin})
      if (!is_finite(column)) return false;
  return true;
}

std::vector<Vec3f> bake_positions(const GeometryMesh& mesh, const Transform& to_world) {
  const Vec3d x(to_world.x), y(to_world.y), z(to_world.z), origin(to_world.origin);
  std::vector<Vec3f> baked;
  baked.reserve(mesh.positions.size() + 2);
  for (const Vec3f& p : mesh.positions)
    baked.emplace_back(x * double(p.x) + y * double(p.y) + z * double(p.z) + origin);
  baked.resize(mesh.positions.size() + 2);  // 24 readable bytes past the last position
  return baked;
}

void sort_hits(std::vector<RawHit>& hits) {
  const auto order = [](const RawHit& h) { return std::tuple(h.t, h.instance, h.primitive); };
  std::sort(hits.begin(), hits.end(), [&](const RawHit& a, const RawHit& b) { return order(a) < order(b); });
  const auto same = [](const RawHit& a, const RawHit& b) {
    return a.instance == b.instance && a.primitive == b.primitive;
  };
  hits.erase(std::unique(hits.begin(), hits.end(), same), hits.end());
}

}  // namespace vernier
