// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scene/accel/accelerator.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace vernier {

/// Embree's device and what it has built of a geometry: how meshes and instances get into it, what that
/// takes, and what it complains of.
class EmbreeScene {
 public:
  /// `filter` is asked of hits on filtered instances; null: none are. Throws Error(memory) and Error(input).
  EmbreeScene(const Geometry& geometry, RTCSceneFlags flags, RTCFilterFunctionN filter);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_.get(); }
  /// Sum of the coordinates of an origin from which rays can be carried into every mesh.
  float farthest_origin() const { return farthest_origin_; }
  const AcceleratorStats& stats() const { return stats_; }

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  using DevicePtr = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
  using ScenePtr = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;
  /// A mesh in the world whose instance's map has no inverse.
  struct BakedMesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> hittable;
  };

  /// The scenes of the meshes that instances place, all at once: many small ones would otherwise leave
  /// threads idle.
  void build_shared_meshes(const Geometry& geometry, const std::vector<double>& stretches);
  /// Called for many instances at once.
  void add_instance(uint32_t id, const Geometry& geometry, bool is_placed);
  bool is_filtered(const GeometryInstance& instance) const { return instance.filtered && filter_; }
  /// Index in mesh_scenes_.
  size_t shared_scene(const GeometryInstance& instance) const {
    return 2 * size_t(instance.mesh) + is_filtered(instance);
  }
  ScenePtr new_scene();
  void commit(RTCScene scene);
  void attach_mesh(RTCScene scene, const GeometryMesh& mesh, const std::vector<Triangle>& hittable,
                   uint32_t id, bool filtered);
  void attach_placed(RTCScene mesh_scene, const Transform& to_world, uint32_t id);
  void check_errors();

  static void note_error(void* self, RTCError code, const char* text);
  static bool note_memory(void* self, ssize_t bytes, bool post);

  // Embree counts memory until its device goes, so what it counts in is declared first.
  std::atomic<ssize_t> bytes_ = 0;
  std::mutex error_mutex_;
  RTCError error_ = RTC_ERROR_NONE;
  std::string error_text_;
  const RTCSceneFlags flags_;
  const RTCFilterFunctionN filter_;
  float farthest_origin_ = 1e18f;
  AcceleratorStats stats_;
  std::vector<std::unique_ptr<BakedMesh>> baked_;  ///< by instance; null: placed by its map
  /// By mesh: its triangles where some are left out, else empty.
  std::vector<std::vector<Triangle>> hittable_;
  DevicePtr device_;
  std::vector<ScenePtr> mesh_scenes_;  ///< two a mesh: unfiltered, filtered; null where not needed
  ScenePtr scene_;
};

}  // namespace vernier
