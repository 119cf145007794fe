// SPDX-License-Identifier: Apache-2.0
#include "scene/import/instant.h"

#include <algorithm>

#include "scene/import/cameras_lights.h"

namespace vernier {
namespace {

bool same(const std::vector<PropertyValue>& a, const std::vector<PropertyValue>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.pointer == y.pointer && x.value == y.value;
  });
}

}  // namespace

Instant instant_at(const PosedDescription& posed, double seconds) {
  std::vector<Notice> said;  // of the pose in the middle
  std::vector<NodePose> poses = rest_pose(posed.document, said);
  std::vector<PropertyValue> values;
  pose_by_animations(posed.document, posed.options.animation, seconds, poses, values, said);
  Instant instant;
  instant.changes = !same(values, posed.values);
  for (size_t i = 0; i < poses.size(); ++i) {
    instant.changes = instant.changes || poses[i].visible != posed.poses[i].visible;
    poses[i].visible = posed.poses[i].visible;
  }
  instant.places = place_nodes(posed.document, poses);
  add_cameras_and_lights(posed.document, instant.places, instant.seen);
  InstancePlacer placer(posed.document, posed.materials, posed.options.variant);
  placer.add_nodes(instant.places, poses);
  instant.placement = placer.take();
  return instant;
}

void separate_corners(MeshDescription& mesh) {
  const auto separate = [&](auto& values) {
    if (values.empty()) return;
    std::decay_t<decltype(values)> corners;
    corners.reserve(3 * mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles)
      for (const uint32_t vertex : triangle) corners.push_back(values[vertex]);
    values = std::move(corners);
  };
  separate(mesh.positions);
  separate(mesh.normals);
  separate(mesh.tangents);
  for (size_t set = 0; set < mesh.texcoord_set_count(); ++set) separate(mesh.texcoord_set(set));
  separate(mesh.colors);
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.triangles[i] = {3 * i, 3 * i + 1, 3 * i + 2};
}

}  // namespace vernier
