// SPDX-License-Identifier: Apache-2.0
#include "scene/accel/embree.h"

#include <algorithm>
#include <bit>

#include "core/math/rounding.h"
#include "scene/accel/embree_scene.h"
#include "scene/accel/instance.h"
#include "scene/accel/query.h"
#include "scene/accel/triangle_set.h"

namespace vernier {
namespace {

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
  if (args->valid[0] == -1 && is_endpoint_triangle(*query.ray, raw_hit(*args, query).triangle()))
    args->valid[0] = 0;
}

/// The same, and keeps hits on clear instances while it lets the ray pass them.
void pass_clear(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  const RawHit hit = raw_hit(*args, query);
  const bool at_end = is_endpoint_triangle(*query.ray, hit.triangle());
  if (!at_end && !(*query.clear)[hit.instance]) return;
  if (!at_end) query.collected->push_back(hit);
  args->valid[0] = 0;
}

/// Keeps every hit and rejects it, so that traversal goes on.
void collect_hit(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] != -1) return;
  const auto& query = *reinterpret_cast<const Query*>(args->context);
  const RawHit hit = raw_hit(*args, query);
  if (!is_endpoint_triangle(*query.ray, hit.triangle())) query.collected->push_back(hit);
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

class EmbreeAccelerator final : public Accelerator {
 public:
  EmbreeAccelerator(const Geometry& geometry, RTCSceneFlags flags)
      : scene_(geometry, flags | query_filter_flag, geometry.filter ? filter_hit : nullptr),
        filter_(geometry.filter),
        robust_(flags & RTC_SCENE_FLAG_ROBUST),
        farthest_origin_(scene_.farthest_origin()) {
    if (has_clear_instances(geometry))
      for (const auto& instance : geometry.instances) clear_.push_back(instance.clear);
  }

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
  AcceleratorStats stats() const override { return scene_.stats(); }

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

  const EmbreeScene scene_;
  const HitFilter* filter_;
  std::vector<bool> clear_;  ///< by instance; empty: none is
  const bool robust_;
  const float farthest_origin_;
};

inline std::optional<RawHit> EmbreeAccelerator::closest(const ScaledRay& scaled, const Ray& world) const {
  RTCRayHit rayhit = embree_ray(scaled.ray, robust_);
  Query query{{}, &world, scaled.t_scale, filter_};
  float t_min = scaled.ray.t_min;
  while (true) {
    intersect(scene_.get(), rayhit, query);
    if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const RawHit hit = raw_hit(rayhit.ray.tfar * scaled.t_scale, rayhit.hit);
    if (!is_endpoint_triangle(world, hit.triangle())) return hit;
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
  const bool has_ends = world.origin_triangle != TriangleId{} || world.target_triangle != TriangleId{};
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

}  // namespace

std::unique_ptr<Accelerator> build_embree_fast(const Geometry& geometry) {
  return std::make_unique<EmbreeAccelerator>(geometry, RTC_SCENE_FLAG_NONE);
}

std::unique_ptr<Accelerator> build_embree_robust(const Geometry& geometry) {
  return std::make_unique<EmbreeAccelerator>(geometry, RTC_SCENE_FLAG_ROBUST);
}

}  // namespace vernier
