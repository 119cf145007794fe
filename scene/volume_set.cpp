// SPDX-License-Identifier: Apache-2.0
#include "scene/volume_set.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/base/parallel.h"
#include "scene/closed_surface.h"

namespace vernier {
namespace {

using Group = std::vector<uint32_t>;  // instances

Bounds bounds_of(const SceneGeometry& geometry, const Group& group) {
  Bounds box;
  for (const uint32_t i : group)
    for (uint32_t t = 0; t < geometry.triangle_count(i); ++t)
      for (const Vec3f& corner : geometry.triangle(i, t)) box.add(corner);
  return box;
}

struct Enclosure {
  bool is_closed, is_inward;
};

Enclosure enclosure_of(const SceneGeometry& geometry, const Group& group) {
  const Bounds box = bounds_of(geometry, group);
  ClosedSurfaceTest test(box.lower, box.upper);
  for (const uint32_t i : group)
    for (uint32_t t = 0; t < geometry.triangle_count(i); ++t) {
      const auto [a, b, c] = geometry.triangle(i, t);
      test.add(a, b, c);
    }
  return {test.is_closed(), test.is_inward()};
}

/// Over all of the shutter.
Bounds swept_bounds(const SceneGeometry& geometry, const Group& group) {
  Bounds box = bounds_of(geometry, group);
  for (const uint32_t i : group)
    if (geometry.moments(i) > 0) box.add(geometry.bounds(i));
  return box;
}

/// Candidates by object and material.
std::map<std::pair<uint64_t, uint32_t>, Group> parts_of_objects(
    std::span<const InstanceDescription> instances, std::span<const MaterialDescription> materials) {
  constexpr uint64_t of_its_own = uint64_t(1) << 32;
  std::map<std::pair<uint64_t, uint32_t>, Group> parts;
  for (uint32_t i = 0; i < instances.size(); ++i) {
    const auto& instance = instances[i];
    if (!materials[instance.material].bounds_volume()) continue;
    const uint64_t object = instance.object ? *instance.object : of_its_own + i;
    parts[{object, instance.material}].push_back(i);
  }
  return parts;
}

/// Those of groups that are closed go to `closed`; the others are returned.
std::vector<Group> take_closed(const SceneGeometry& geometry, std::vector<Group> groups,
                               std::vector<VolumeBoundaries::Boundary>& closed) {
  std::vector<Enclosure> enclosures(groups.size());
  parallel_for(groups.size(), [&](size_t i) { enclosures[i] = enclosure_of(geometry, groups[i]); });
  std::vector<Group> rest;
  for (size_t i = 0; i < groups.size(); ++i) {
    if (enclosures[i].is_closed)
      closed.push_back({std::move(groups[i]), enclosures[i].is_inward});
    else
      rest.push_back(std::move(groups[i]));
  }
  return rest;
}

/// Two of the boxes have a point in common.
bool any_touch(std::vector<Bounds> boxes) {
  std::sort(boxes.begin(), boxes.end(), [](const auto& a, const auto& b) { return a.lower.x < b.lower.x; });
  for (size_t i = 0; i < boxes.size(); ++i)
    for (size_t j = i + 1; j < boxes.size() && boxes[j].lower.x <= boxes[i].upper.x; ++j)
      if (boxes[i].touches(boxes[j])) return true;
  return false;
}

}  // namespace

VolumeBoundaries::VolumeBoundaries(const SceneGeometry& geometry,
                                   std::span<const InstanceDescription> instances,
                                   std::span<const MaterialDescription> materials,
                                   const std::vector<bool>& is_cut) {
  // What one material covers of an object is closed, or all such parts of the object are together.
  std::map<uint64_t, Group> open_parts;
  std::vector<Group> groups;
  for (auto& [key, group] : parts_of_objects(instances, materials)) {
    const auto whole =
        std::stable_partition(group.begin(), group.end(), [&](uint32_t i) { return is_cut[i]; });
    cut.insert(cut.end(), group.begin(), whole);
    group.erase(group.begin(), whole);
    if (!group.empty()) groups.push_back(std::move(group));
  }
  std::sort(cut.begin(), cut.end());
  for (const Group& group : take_closed(geometry, std::move(groups), closed)) {
    const auto& first = instances[group[0]];
    if (!first.object) {
      open.push_back(group[0]);
      continue;
    }
    Group& of_object = open_parts[*first.object];
    of_object.insert(of_object.end(), group.begin(), group.end());
  }
  std::vector<Group> objects;
  objects.reserve(open_parts.size());
  for (auto& [object, group] : open_parts) objects.push_back(std::move(group));
  for (const Group& group : take_closed(geometry, std::move(objects), closed))
    open.insert(open.end(), group.begin(), group.end());
  std::sort(open.begin(), open.end());
}

VolumeSet::VolumeSet(const VolumeBoundaries& boundaries, const SceneGeometry& geometry,
                     std::span<const Material> materials, std::span<const uint32_t> material_of_instance) {
  const auto& closed = boundaries.closed;
  if (closed.empty()) return;
  std::vector<Bounds> boxes(closed.size());
  parallel_for(closed.size(), [&](size_t i) { boxes[i] = swept_bounds(geometry, closed[i].instances); });
  // A box within another has less surface, whatever their shapes.
  std::vector<size_t> order(closed.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return boxes[a].half_area() > boxes[b].half_area(); });
  of_instance_.resize(geometry.instance_count());
  media_.reserve(order.size());
  bounds_.reserve(order.size());
  for (const size_t i : order) {
    const Material& material = materials[material_of_instance[closed[i].instances[0]]];
    for (const uint32_t instance : closed[i].instances)
      of_instance_[instance] = {uint32_t(media_.size()), closed[i].is_inward};
    media_.push_back({material.extinction(), material.interior_ior(), material.scattering(),
                      material.scattering_anisotropy(), true});
    bounds_.push_back(boxes[i]);
    all_bounds_.add(boxes[i]);
  }
  are_nested_ = any_touch(bounds_);
}

void VolumeSet::find_dim_ones(const std::vector<bool>& clear, std::span<const Material> materials,
                              std::span<const uint32_t> material_of_instance, const LightSet& lights) {
  // Beyond some millions of pairs looking takes longer than it saves.
  if (media_.empty() || media_.size() * lights.size() > 10'000'000) return;
  for (size_t v = 0; v < media_.size(); ++v) {
    bool sees = false;
    for (size_t i = 0; i < lights.size() && !sees; ++i)
      if (const auto at = lights[i].bounds()) sees = at->box.touches(bounds_[v]);
    media_[v].sees_lights = sees;
  }
  for (size_t i = 0; i < of_instance_.size(); ++i)
    if (const uint32_t v = of_instance_[i].volume; v != MediumStack::air)
      media_[v].sees_lights |= clear[i] || materials[material_of_instance[i]].is_emissive();
}

Stretch VolumeSet::in_air(const Ray& ray, float begin, float end) const {
  // In double precision: a ray may begin far outside, where the ball is seen small.
  const Vec3d direction(ray.direction), from = Vec3d(ray.origin) - Vec3d(air_fills_->center);
  const double square_length = length_squared(direction), middle = -dot(from, direction) / square_length;
  const double aside2 = length_squared(from + middle * direction);
  const double half2 = square(double(air_fills_->radius)) - aside2;
  if (!(half2 > 0)) return {air_, begin, begin};
  const double half = std::sqrt(half2 / square_length);
  const float first = std::max(begin, float(middle - half));
  return {air_, first, std::max(first, std::min(end, float(middle + half)))};
}

bool VolumeSet::may_contain(const Vec3f& point) const {
  if (!all_bounds_.contains(point)) return false;
  return std::any_of(bounds_.begin(), bounds_.end(), [&](const Bounds& box) { return box.contains(point); });
}

}  // namespace vernier
