#include "scene/accel/embree.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <mutex>

#include "core/base/error.h"
#include "scene/accel/instance.h"

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
  const HitFilter* filter = nullptr;
  std::vector<RawHit>* collected = nullptr;
  float t_scale = 1;
};

// Embree 3 takes the context and its filter, Embree 4 takes arguments that hold both.
#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& rayhit, Query& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitRayQueryContext(&query.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  if (filter) {
    arguments.filter = filter;
    arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  }
  rtcIntersect1(scene, &rayhit, &arguments);
}

void occluded(RTCScene scene, RTCRay& ray, Query& query) {
  rtcInitRayQueryContext(&query.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  rtcOccluded1(scene, &ray, &arguments);
}
#else
void intersect(RTCScene scene, RTCRayHit& rayhit, Query& query, RTCFilterFunctionN filter = nullptr) {
  rtcInitIntersectContext(&query.context);
  query.context.filter = filter;
  rtcIntersect1(scene, &query.context, &rayhit);
}

void occluded(RTCScene scene, RTCRay& ray, Query& query) {
  rtcInitIntersectContext(&query.context);
  rtcOccluded1(scene, &query.context, &ray);
}
#endif

RawHit raw_hit(float t, const RTCHit& hit) {
  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  return {t, hit.u, hit.v, instanced ? hit.instID[0] : hit.geomID, hit.primID};
}

RawHit raw_hit(const RTCFilterFunctionNArguments& args) {
  return raw_hit(RTCRayN_tfar(args.ray, args.N, 0), rtcGetHitFromHitN(args.hit, args.N, 0));
}

/// Asks the scene's filter.
void filter_hit(const RTCFilterFunctionNArguments* args) {
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  RawHit hit = raw_hit(*args);
  hit.t *= query.t_scale;
  if (args->valid[0] == -1 && !query.filter->accept(*query.ray, hit)) args->valid[0] = 0;
}

/// Keeps every hit and rejects it, so that traversal goes on.
void collect_hit(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  query.collected->push_back(raw_hit(*args));
  args->valid[0] = 0;
}

/// Embree's interval is closed in its robust mode, ours is open: shrink by the last bit at each end. Zero
/// goes to the smallest normal number, since threads that flush denormals would read a denormal as zero
/// again. The upper end of an infinite ray becomes the largest finite number, so that an overflowed t is no
/// hit.
float embree_t_near(float t_min) {
  constexpr float smallest = std::numeric_limits<float>::min();
  return t_min < smallest ? smallest : std::bit_cast<float>(std::bit_cast<uint32_t>(t_min) + 1);
}
float embree_t_far(float t_max) { return std::bit_cast<float>(std::bit_cast<uint32_t>(t_max) - 1); }

RTCRay embree_ray(const Ray& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          embree_t_near(ray.t_min),
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          embree_t_far(ray.t_max),
          ~0u,
          0,
          0};
}

RTCRayHit embree_ray_hit(const Ray& ray) {
  RTCRayHit rayhit;
  rayhit.ray = embree_ray(ray);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return rayhit;
}

/// Embree takes direction components below 1e-18 for zero and lets rays of NaN wander through the tree, so
/// rays outside these limits take the long way round.
bool is_plain(const Ray& ray) {
  const float size = std::abs(ray.direction.x) + std::abs(ray.direction.y) + std::abs(ray.direction.z);
  const float distance = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
  return size >= 1e-6f && size <= 1e6f && distance <= std::numeric_limits<float>::max() &&
         ray.t_min < ray.t_max && ray.t_max > 0;
}

/// The same ray with a direction of about unit length and t counted in it; t_scale * its t is the t of `ray`.
/// Empty when the ray can hit nothing.
struct ScaledRay {
  Ray ray;
  float t_scale;
};
std::optional<ScaledRay> scaled_to_unit(const Ray& ray) {
  const Vec3f magnitudes = abs(ray.direction);
  if (!is_finite(ray.origin) || !is_finite(ray.direction) || max_component(magnitudes) == 0) return {};
  if (!(ray.t_min < ray.t_max) || !(ray.t_max > 0)) return {};
  int exponent = 0;
  std::frexp(max_component(magnitudes), &exponent);
  Ray scaled = ray;
  for (int axis = 0; axis < 3; ++axis) scaled.direction[axis] = std::ldexp(ray.direction[axis], -exponent);
  scaled.t_min = std::ldexp(std::max(ray.t_min, 0.f), exponent);
  scaled.t_max = std::ldexp(ray.t_max, exponent);
  if (!(scaled.t_max > scaled.t_min)) return {};
  return ScaledRay{scaled, std::ldexp(1.f, -exponent)};
}

class EmbreeAccelerator final : public Accelerator {
 public:
  EmbreeAccelerator(const Geometry& geometry, RTCSceneFlags flags);

  std::optional<RawHit> closest(const Ray& ray) const override {
    if (!is_plain(ray)) [[unlikely]]
      return closest_scaled(ray);
    return closest_plain(ray, ray, 1);
  }

  bool occluded(const Ray& ray) const override {
    if (!is_plain(ray)) [[unlikely]] {
      const auto scaled = scaled_to_unit(ray);
      return scaled && occluded_plain(ray, scaled->ray, scaled->t_scale);
    }
    return occluded_plain(ray, ray, 1);
  }

  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override;
  AcceleratorStats stats() const override { return stats_; }

 private:
  std::optional<RawHit> closest_plain(const Ray& world, const Ray& scaled, float t_scale) const {
    RTCRayHit rayhit = embree_ray_hit(scaled);
    Query query{{}, &world, filter_, nullptr, t_scale};
    intersect(scene_.get(), rayhit, query);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return raw_hit(rayhit.ray.tfar, rayhit.hit);
  }

  bool occluded_plain(const Ray& world, const Ray& scaled, float t_scale) const {
    RTCRay embree = embree_ray(scaled);
    Query query{{}, &world, filter_, nullptr, t_scale};
    vernier::occluded(scene_.get(), embree, query);
    return embree.tfar < 0;
  }

  std::optional<RawHit> closest_scaled(const Ray& ray) const;
  ScenePtr new_scene(RTCSceneFlags flags);
  void commit(RTCScene scene);
  void attach_mesh(RTCScene scene, const GeometryMesh& mesh, uint32_t id, bool filtered);
  void attach_instance(RTCScene mesh_scene, const Transform& to_world, uint32_t id);
  void check_errors();

  static void note_error(void* self, RTCError code, const char* text);
  static bool note_memory(void* self, ssize_t bytes, bool post);

  std::atomic<ssize_t> bytes_ = 0;
  std::mutex error_mutex_;
  RTCError error_ = RTC_ERROR_NONE;
  std::string error_text_;
  const HitFilter* filter_;
  AcceleratorStats stats_;
  std::vector<std::vector<Vec3f>> baked_;
  DevicePtr device_;
  std::vector<ScenePtr> mesh_scenes_;  ///< by mesh, and apart for filtered instances; null where not needed
  ScenePtr scene_;
};

EmbreeAccelerator::EmbreeAccelerator(const Geometry& geometry, RTCSceneFlags flags)
    : filter_(geometry.filter), device_(rtcNewDevice(nullptr)), mesh_scenes_(2 * geometry.meshes.size()) {
  if (!device_)
    throw Error(ErrorKind::memory,
                "Embree cannot start (error " + std::to_string(rtcGetDeviceError(nullptr)) + ")");
  rtcSetDeviceErrorFunction(device_.get(), note_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_.get(), note_memory, this);
  const auto start = std::chrono::steady_clock::now();
  scene_ = new_scene(flags);
  for (uint32_t id = 0; id < geometry.instances.size(); ++id) {
    const GeometryInstance& instance = geometry.instances[id];
    const GeometryMesh& mesh = geometry.meshes[instance.mesh];
    if (mesh.triangles.empty()) continue;
    const bool filtered = instance.filtered && filter_;
    if (instance.to_world.is_identity()) {
      attach_mesh(scene_.get(), mesh, id, filtered);
    } else if (!is_invertible(instance.to_world)) {
      baked_.push_back(bake_positions(mesh, instance.to_world));
      attach_mesh(scene_.get(), {baked_.back(), mesh.triangles}, id, filtered);
    } else {
      ScenePtr& shared = mesh_scenes_[2 * instance.mesh + filtered];
      if (!shared) {
        shared = new_scene(flags);
        attach_mesh(shared.get(), mesh, 0, filtered);
        commit(shared.get());
      }
      attach_instance(shared.get(), instance.to_world, id);
    }
  }
  commit(scene_.get());
  stats_.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  stats_.bytes = static_cast<size_t>(bytes_.load());
  for (const auto& positions : baked_) stats_.bytes += positions.size() * sizeof(Vec3f);
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

void EmbreeAccelerator::attach_mesh(RTCScene scene, const GeometryMesh& mesh, uint32_t id, bool filtered) {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                             sizeof(Vec3f), mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                             sizeof(Triangle), mesh.triangles.size());
  if (filtered) {
    rtcSetGeometryIntersectFilterFunction(geometry, filter_hit);
    rtcSetGeometryOccludedFilterFunction(geometry, filter_hit);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

void EmbreeAccelerator::attach_instance(RTCScene mesh_scene, const Transform& to_world, uint32_t id) {
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, mesh_scene);
  static_assert(sizeof(Transform) == 12 * sizeof(float));
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, id);
  rtcReleaseGeometry(geometry);
  check_errors();
}

std::optional<RawHit> EmbreeAccelerator::closest_scaled(const Ray& ray) const {
  const auto scaled = scaled_to_unit(ray);
  if (!scaled) return {};
  auto hit = closest_plain(ray, scaled->ray, scaled->t_scale);
  if (hit) hit->t *= scaled->t_scale;
  return hit;
}

void EmbreeAccelerator::all_hits(const Ray& ray, std::vector<RawHit>& sorted) const {
  sorted.clear();
  const auto scaled = scaled_to_unit(ray);
  if (!scaled) return;
  RTCRayHit rayhit = embree_ray_hit(scaled->ray);
  Query query{{}, &ray, filter_, &sorted, scaled->t_scale};
  intersect(scene_.get(), rayhit, query, collect_hit);
  for (RawHit& hit : sorted) hit.t *= scaled->t_scale;
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
