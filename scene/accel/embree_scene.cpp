// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/embree_scene.h"

#include <algorithm>
#include <chrono>

#include "core/base/parallel.h"
#include "scene/accel/instance.h"
#include "scene/accel/triangle_set.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// By instance, how much longer the way is at most in the space of its mesh; 0: rays are not carried there.
std::vector<double> stretches_of(const Geometry& geometry) {
  std::vector<double> stretches(geometry.instances.size());
  parallel_for(stretches.size(), [&](size_t i) {
    const GeometryInstance& instance = geometry.instances[i];
    if (geometry.meshes[instance.mesh].triangles.empty() || instance.to_world.is_identity()) return;
    const auto to_mesh = WorldToMesh::of(instance.to_world);
    if (!to_mesh) return;
    const Vec3d stretch = abs(to_mesh->x) + abs(to_mesh->y) + abs(to_mesh->z);
    stretches[i] = std::max({stretch.x, stretch.y, stretch.z});
  });
  return stretches;
}

}  // namespace

EmbreeScene::EmbreeScene(const Geometry& geometry, RTCSceneFlags flags, RTCFilterFunctionN filter)
    : flags_(flags),
      filter_(filter),
      device_(rtcNewDevice(nullptr)),
      mesh_scenes_(2 * geometry.meshes.size()) {
  if (!device_)
    throw Error(ErrorKind::memory,
                "Embree cannot start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device_.get(), note_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_.get(), note_memory, this);
  const auto start = std::chrono::steady_clock::now();
  // Embree's robust mode would hit triangles without area; those with such indices it leaves out.
  hittable_.resize(geometry.meshes.size());
  parallel_for(hittable_.size(), [&](size_t i) { hittable_[i] = without_unhittable(geometry.meshes[i]); });
  const std::vector<double> stretches = stretches_of(geometry);
  for (const double stretch : stretches)
    farthest_origin_ = std::min(farthest_origin_, static_cast<float>(1e18 / std::max(stretch, 1.0)));
  build_shared_meshes(geometry, stretches);
  scene_ = new_scene();
  baked_.resize(geometry.instances.size());
  parallel_for(baked_.size(), [&](size_t id) { add_instance(uint32_t(id), geometry, stretches[id] > 0); });
  commit(scene_.get());
  stats_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  stats_.bytes = static_cast<size_t>(bytes_.load());
  for (const auto& mesh : baked_)
    if (mesh)
      stats_.bytes += mesh->positions.size() * sizeof(Vec3f) + mesh->hittable.size() * sizeof(Triangle);
  for (const auto& triangles : hittable_) stats_.bytes += triangles.size() * sizeof(Triangle);
}

void EmbreeScene::build_shared_meshes(const Geometry& geometry, const std::vector<double>& stretches) {
  std::vector<bool> is_shared(mesh_scenes_.size());
  for (size_t i = 0; i < stretches.size(); ++i)
    if (stretches[i] > 0) is_shared[shared_scene(geometry.instances[i])] = true;
  std::vector<size_t> shared;
  for (size_t i = 0; i < is_shared.size(); ++i)
    if (is_shared[i]) shared.push_back(i);
  parallel_for(shared.size(), [&](size_t i) {
    const size_t mesh = shared[i] / 2;
    ScenePtr scene = new_scene();
    attach_mesh(scene.get(), geometry.meshes[mesh], hittable_[mesh], 0, shared[i] % 2);
    commit(scene.get());
    mesh_scenes_[shared[i]] = std::move(scene);
  });
}

void EmbreeScene::add_instance(uint32_t id, const Geometry& geometry, bool is_placed) {
  const GeometryInstance& instance = geometry.instances[id];
  const GeometryMesh& mesh = geometry.meshes[instance.mesh];
  if (mesh.triangles.empty()) return;
  if (instance.to_world.is_identity()) {
    attach_mesh(scene_.get(), mesh, hittable_[instance.mesh], id, is_filtered(instance));
  } else if (is_placed) {
    attach_placed(mesh_scenes_[shared_scene(instance)].get(), instance.to_world, id);
  } else {
    baked_[id] = std::make_unique<BakedMesh>();
    baked_[id]->positions = bake_positions(mesh, instance.to_world);
    const GeometryMesh baked{baked_[id]->positions, mesh.triangles};
    baked_[id]->hittable = without_unhittable(baked);
    attach_mesh(scene_.get(), baked, baked_[id]->hittable, id, is_filtered(instance));
  }
}

EmbreeScene::ScenePtr EmbreeScene::new_scene() {
  ScenePtr scene(rtcNewScene(device_.get()));
  check_errors();
  rtcSetSceneFlags(scene.get(), flags_);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

void EmbreeScene::commit(RTCScene scene) {
  rtcCommitScene(scene);
  check_errors();
}

void EmbreeScene::attach_mesh(RTCScene scene, const GeometryMesh& mesh, const std::vector<Triangle>& hittable,
                              uint32_t id, bool filtered) {
  const std::span<const Triangle> triangles = hittable.empty() ? mesh.triangles : hittable;
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto set_vertices = [&](unsigned moment, std::span<const Vec3f> positions) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, moment, RTC_FORMAT_FLOAT3, positions.data(),
                               0, sizeof(Vec3f), positions.size());
  };
  if (mesh.moves()) {
    rtcSetGeometryTimeStepCount(geometry, unsigned(mesh.moments.size()));
    for (unsigned i = 0; i < mesh.moments.size(); ++i) set_vertices(i, mesh.moments[i]);
  } else {
    set_vertices(0, mesh.positions);
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                             sizeof(Triangle), triangles.size());
  if (filtered) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter_);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

void EmbreeScene::attach_placed(RTCScene mesh_scene, const Transform& to_world, uint32_t id) {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh_scene);
  static_assert(sizeof(Transform) == 12 * sizeof(float));
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

void EmbreeScene::check_errors() {
  const std::lock_guard lock(error_mutex_);
  if (error_ == RTC_ERROR_NONE) return;
  if (error_ == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::memory, "out of memory while building the accelerator: " + error_text_);
  throw Error(ErrorKind::input, "Embree cannot take this scene: " + error_text_);
}

void EmbreeScene::note_error(void* self, RTCError code, const char* text) {
  auto* scene = static_cast<EmbreeScene*>(self);
  const std::lock_guard lock(scene->error_mutex_);
  if (scene->error_ != RTC_ERROR_NONE) return;  // the first is the cause
  scene->error_ = code;
  scene->error_text_ = text ? text : "";
}

bool EmbreeScene::note_memory(void* self, ssize_t bytes, bool) {
  static_cast<EmbreeScene*>(self)->bytes_ += bytes;
  return true;
}

}  // namespace vernier
