// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/embree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <mutex>

#include "core/base/parallel.h"
#include "core/math/rounding.h"
#include "scene/accel/instance.h"
#include "scene/accel/query.h"
#include "scene/accel/triangle_set.h"
#include "vernier/error.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace vernier {
namespace {

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePtr = std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release>;
using ScenePtr = std::unique_ptr<std::remove_pointer_t<RTCScene>, Release>;

// Embree 3 takes a context that holds the filter of the query, Embree 4 takes arguments that hold both.
#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
constexpr RTCSceneFlags query_filter_flag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// What the filter callbacks need to know of the query; Embree hands its first member back to them.
struct Query {
  EmbreeContext context;
  const Ray* ray = nullptr;  ///< in world space: Embree shows filters the ray in the instance's space
  float t_scale = 1;         ///< times Embree's t is the ray's
  const HitFilter* filter = nullptr;
  std::vector<RawHit>* collected = nullptr;
  const std::vector<bool>* clear = nullptr;  ///< by instance
};

#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& rayhit, Query& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitRayQueryContext(&query.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = filter;
  if (filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &rayhit, &arguments);
}

void occlude(RTCScene scene, RTCRay& ray, Query& query, RTCFilterFunctionN filter) {
  rtcInitRayQueryContext(&query.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = filter;
  if (filter) arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcOccluded1(scene, &ray, &arguments);
}
#else
void intersect(RTCScene scene, RTCRayHit& rayhit, Query& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitIntersectContext(&query.context);
  query.context.filter = filter;
  rtcIntersect1(scene, &query.context, &rayhit);
}

void occlude(RTCScene scene, RTCRay& ray, Query& query, RTCFilterFunctionN filter) {
  rtcInitIntersectContext(&query.context);
  query.context.filter = filter;
  rtcOccluded1(scene, &query.context, &ray);
}
#endif

RawHit raw_hit(float t, const RTCHit& hit) {
  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  return {t, hit.u, hit.v, instanced ? hit.instID[0] : hit.geomID, hit.primID};
}

RawHit raw_hit(const RTCFilterFunctionNArguments& args, const Query& query) {
  const float t = RTCRayN_tfar(args.ray, args.N, 0) * query.t_scale;
  return raw_hit(t, rtcGetHitFromHitN(args.hit, args.N, 0));
}

/// Asks the scene's filter.
void filter_hit(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  if (args->valid[0] == -1 && !query.filter->accept(*query.ray, raw_hit(*args, query))) args->valid[0] = 0;
}

/// Lets occlusion queries pass the triangles at the ends of the ray.
void pass_ends(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  if (args->valid[0] == -1 && is_at_end(*query.ray, raw_hit(*args, query))) args->valid[0] = 0;
}

/// The same, and keeps hits on clear instances while it lets the ray pass them.
void pass_clear(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  const RawHit hit = raw_hit(*args, query);
  const bool at_end = is_at_end(*query.ray, hit);
  if (!at_end && !(*query.clear)[hit.instance]) return;
  if (!at_end) query.collected->push_back(hit);
  args->valid[0] = 0;
}

/// Keeps every hit and rejects it, so that traversal goes on.
void collect_hit(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  const RawHit hit = raw_hit(*args, query);
  if (!is_at_end(*query.ray, hit)) query.collected->push_back(hit);
  args->valid[0] = 0;
}

/// Embree's interval is closed in its robust mode, in its fast mode above only, and ours is open: shrink by
/// the last bit at each closed end. Zero goes to the smallest normal number, since threads that flush
/// denormals would read a denormal as zero again. The end of an infinite ray becomes the largest finite
/// number, so that an overflowed t is no hit.
float above(float t_min) {
  constexpr float smallest = std::numeric_limits<float>::min();
  return t_min < smallest ? smallest : std::bit_cast<float>(std::bit_cast<uint32_t>(t_min) + 1);
}

RTCRayHit embree_ray(const Ray& ray, bool robust) {
  RTCRayHit rayhit;
  rayhit.ray.org_x = ray.origin.x;
  rayhit.ray.org_y = ray.origin.y;
  rayhit.ray.org_z = ray.origin.z;
  rayhit.ray.tnear = robust ? above(ray.t_min) : std::max(ray.t_min, 0.f);
  rayhit.ray.dir_x = ray.direction.x;
  rayhit.ray.dir_y = ray.direction.y;
  rayhit.ray.dir_z = ray.direction.z;
  rayhit.ray.time = ray.time;
  rayhit.ray.tfar = below(ray.t_max);
  rayhit.ray.mask = ~0u;
  rayhit.ray.id = 0;
  rayhit.ray.flags = 0;
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return rayhit;
}

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

class EmbreeAccelerator final : public Accelerator {
 public:
  EmbreeAccelerator(const Geometry& geometry, RTCSceneFlags flags);

  std::optional<RawHit> closest(const Ray& ray) const override {
    if (is_plain(ray)) [[likely]]
      return closest({ray, 1}, ray);
    const auto scaled = scaled_to_unit(ray);
    return scaled && is_plain(scaled->ray) ? closest(*scaled, ray) : std::nullopt;
  }

  bool occluded(const Ray& ray) const override { return occluded(ray, nullptr); }
  bool occluded(const Ray& ray, std::vector<RawHit>& passed) const override {
    return occluded(ray, clear_.empty() ? nullptr : &passed);
  }

  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override;
  AcceleratorStats stats() const override { return stats_; }

 private:
  std::optional<RawHit> closest(const ScaledRay& scaled, const Ray& world) const;
  bool occluded(const Ray& ray, std::vector<RawHit>* passed) const {
    if (is_plain(ray)) [[likely]]
      return occluded({ray, 1}, ray, passed);
    const auto scaled = scaled_to_unit(ray);
    return scaled && is_plain(scaled->ray) && occluded(*scaled, ray, passed);
  }
  bool occluded(const ScaledRay& scaled, const Ray& world, std::vector<RawHit>* passed) const;

  /// Embree takes direction components below 1e-18 for zero, and neither it nor the sum of squares survives
  /// coordinates beyond 1e18: other rays must be scaled first, or miss.
  bool is_plain(const Ray& ray) const {
    const float size = std::abs(ray.direction.x) + std::abs(ray.direction.y) + std::abs(ray.direction.z);
    const float distance = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
    return size >= 1e-6f && size <= 1e6f && distance <= farthest_origin_ && ray.t_min < ray.t_max &&
           ray.t_max > 0;
  }

  /// The scenes of the meshes that instances place, all at once: many small ones would otherwise leave
  /// threads idle.
  void build_shared_meshes(const Geometry& geometry, const std::vector<double>& stretches,
                           RTCSceneFlags flags);
  /// Called for many instances at once.
  void add_instance(uint32_t id, const Geometry& geometry, bool is_placed);
  bool is_filtered(const GeometryInstance& instance) const { return instance.filtered && filter_; }
  /// Index in mesh_scenes_.
  size_t shared_scene(const GeometryInstance& instance) const {
    return 2 * size_t(instance.mesh) + is_filtered(instance);
  }
  ScenePtr new_scene(RTCSceneFlags flags);
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
  const HitFilter* filter_;
  std::vector<bool> clear_;  ///< by instance; empty: none is
  bool robust_;
  float farthest_origin_ = 1e18f;
  AcceleratorStats stats_;
  /// A mesh in the world whose instance's map has no inverse.
  struct BakedMesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> hittable;
  };
  std::vector<std::unique_ptr<BakedMesh>> baked_;  ///< by instance; null: placed by its map
  std::vector<std::vector<Triangle>>
      hittable_;  ///< by mesh: its triangles where some are left out, else empty
  DevicePtr device_;
  std::vector<ScenePtr> mesh_scenes_;  ///< two a mesh: unfiltered, filtered; null where not needed
  ScenePtr scene_;
};

EmbreeAccelerator::EmbreeAccelerator(const Geometry& geometry, RTCSceneFlags flags)
    : filter_(geometry.filter),
      robust_(flags & RTC_SCENE_FLAG_ROBUST),
      device_(rtcNewDevice(nullptr)),
      mesh_scenes_(2 * geometry.meshes.size()) {
  if (!device_)
    throw Error(ErrorKind::memory,
                "Embree cannot start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device_.get(), note_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_.get(), note_memory, this);
  const auto start = std::chrono::steady_clock::now();
  if (has_clear_instances(geometry))
    for (const auto& instance : geometry.instances) clear_.push_back(instance.clear);
  // Embree's robust mode would hit triangles without area; those with such indices it leaves out.
  hittable_.resize(geometry.meshes.size());
  parallel_for(hittable_.size(), [&](size_t i) { hittable_[i] = without_unhittable(geometry.meshes[i]); });
  const std::vector<double> stretches = stretches_of(geometry);
  for (const double stretch : stretches)
    farthest_origin_ = std::min(farthest_origin_, static_cast<float>(1e18 / std::max(stretch, 1.0)));
  build_shared_meshes(geometry, stretches, flags);
  scene_ = new_scene(flags);
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

void EmbreeAccelerator::build_shared_meshes(const Geometry& geometry, const std::vector<double>& stretches,
                                            RTCSceneFlags flags) {
  std::vector<bool> is_shared(mesh_scenes_.size());
  for (size_t i = 0; i < stretches.size(); ++i)
    if (stretches[i] > 0) is_shared[shared_scene(geometry.instances[i])] = true;
  std::vector<size_t> shared;
  for (size_t i = 0; i < is_shared.size(); ++i)
    if (is_shared[i]) shared.push_back(i);
  parallel_for(shared.size(), [&](size_t i) {
    const size_t mesh = shared[i] / 2;
    ScenePtr scene = new_scene(flags);
    attach_mesh(scene.get(), geometry.meshes[mesh], hittable_[mesh], 0, shared[i] % 2);
    commit(scene.get());
    mesh_scenes_[shared[i]] = std::move(scene);
  });
}

void EmbreeAccelerator::add_instance(uint32_t id, const Geometry& geometry, bool is_placed) {
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

ScenePtr EmbreeAccelerator::new_scene(RTCSceneFlags flags) {
  ScenePtr scene(rtcNewScene(device_.get()));
  check_errors();
  rtcSetSceneFlags(scene.get(), flags | query_filter_flag);
  rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

void EmbreeAccelerator::commit(RTCScene scene) {
  rtcCommitScene(scene);
  check_errors();
}

void EmbreeAccelerator::attach_mesh(RTCScene scene, const GeometryMesh& mesh,
                                    const std::vector<Triangle>& hittable, uint32_t id, bool filtered) {
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
    rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_hit);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

void EmbreeAccelerator::attach_placed(RTCScene mesh_scene, const Transform& to_world, uint32_t id) {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh_scene);
  static_assert(sizeof(Transform) == 12 * sizeof(float));
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

inline std::optional<RawHit> EmbreeAccelerator::closest(const ScaledRay& scaled, const Ray& world) const {
  RTCRayHit rayhit = embree_ray(scaled.ray, robust_);
  Query query{{}, &world, scaled.t_scale, filter_};
  float t_min = scaled.ray.t_min;
  while (true) {
    intersect(scene_.get(), rayhit, query);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const RawHit hit = raw_hit(rayhit.ray.tfar * scaled.t_scale, rayhit.hit);
    if (!is_at_end(world, hit)) return hit;
    // So rare that going on from there costs less than a filter, which would be called for every hit.
    // A rounded t may be no larger than t_min, yet there must be an end.
    t_min = std::max(rayhit.ray.tfar, next_float_up(t_min));
    Ray rest = scaled.ray;
    rest.t_min = t_min;
    rayhit = embree_ray(rest, robust_);
  }
}

inline bool EmbreeAccelerator::occluded(const ScaledRay& scaled, const Ray& world,
                                        std::vector<RawHit>* passed) const {
  RTCRayHit rayhit = embree_ray(scaled.ray, robust_);
  Query query{{}, &world, scaled.t_scale, filter_, passed, &clear_};
  const bool has_ends = world.leaves != TriangleId{} || world.reaches != TriangleId{};
  occlude(scene_.get(), rayhit.ray, query, passed ? pass_clear : has_ends ? pass_ends : nullptr);
  return rayhit.ray.tfar < 0;
}

void EmbreeAccelerator::all_hits(const Ray& ray, std::vector<RawHit>& sorted) const {
  sorted.clear();
  const auto scaled = scaled_to_unit(ray);
  if (!scaled || !is_plain(scaled->ray)) return;
  RTCRayHit rayhit = embree_ray(scaled->ray, robust_);
  Query query{{}, &ray, scaled->t_scale, filter_, &sorted};
  intersect(scene_.get(), rayhit, query, collect_hit);
  sort_hits(sorted);
}

void EmbreeAccelerator::check_errors() {
  const std::lock_guard lock(error_mutex_);
  if (error_ == RTC_ERROR_NONE) return;
  if (error_ == RTC_ERROR_OUT_OF_MEMORY)
    throw Error(ErrorKind::memory, "out of memory while building the accelerator: " + error_text_);
  throw Error(ErrorKind::input, "Embree cannot take this scene: " + error_text_);
}

void EmbreeAccelerator::note_error(void* self, RTCError code, const char* text) {
  auto* accelerator = static_cast<EmbreeAccelerator*>(self);
  const std::lock_guard lock(accelerator->error_mutex_);
  if (accelerator->error_ != RTC_ERROR_NONE) return;  // the first is the cause
  accelerator->error_ = code;
  accelerator->error_text_ = text ? text : "";
}

bool EmbreeAccelerator::note_memory(void* self, ssize_t bytes, bool) {
  static_cast<EmbreeAccelerator*>(self)->bytes_ += bytes;
  return true;
}

}  // namespace

std::unique_ptr<Accelerator> build_embree_fast(const Geometry& geometry) {
  return std::make_unique<EmbreeAccelerator>(geometry, RTC_SCENE_FLAG_NONE);
}

std::unique_ptr<Accelerator> build_embree_robust(const Geometry& geometry) {
  return std::make_unique<EmbreeAccelerator>(geometry, RTC_SCENE_FLAG_ROBUST);
}

}  // namespace vernier
