// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/ray_timing.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>

#include "core/base/parallel.h"

namespace vernier::apps {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Processor time of this thread: other programs on the machine hardly disturb it.
double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// Traces every stride-th ray and returns the number of hits, so that nothing is left out as unused.
size_t trace(const Accelerator& accelerator, const RayKind& kind, std::span<const Ray> rays, size_t stride) {
  size_t hits = 0;
  for (size_t i = 0; i < rays.size(); i += stride)
    hits += kind.occlusion ? accelerator.occluded(rays[i]) : accelerator.closest(rays[i]).has_value();
  return hits;
}

/// Seconds that all the rays take, reckoned from those traced.
double time_rays(const TimedAccelerator& candidate, const RayKind& kind, std::span<const Ray> rays,
                 bool all_threads) {
  if (rays.empty()) return 0;
  constexpr size_t rays_a_task = 1 << 12;
  std::atomic<size_t> hits = 0;
  const double start = all_threads ? wall_seconds() : thread_seconds();
  if (all_threads) {
    const size_t task = rays_a_task * candidate.stride;
    parallel_for((rays.size() + task - 1) / task, [&](size_t i) {
      const size_t first = i * task;
      hits += trace(*candidate.accelerator, kind, rays.subspan(first, std::min(task, rays.size() - first)),
                    candidate.stride);
    });
  } else {
    hits += trace(*candidate.accelerator, kind, rays, candidate.stride);
  }
  const double seconds = (all_threads ? wall_seconds() : thread_seconds()) - start;
  const size_t traced = (rays.size() + candidate.stride - 1) / candidate.stride;
  return seconds * double(rays.size()) / double(traced);
}

/// So that one pass over all rays of a kind takes a few seconds at most.
size_t choose_stride(const Accelerator& accelerator, const PathRays& rays) {
  constexpr double longest = 4;
  constexpr size_t probes = 64;
  size_t stride = 1;
  for (const RayKind& kind : ray_kinds) {
    const std::span<const Ray> all = rays.*kind.rays;
    if (all.empty()) continue;
    const size_t step = std::max<size_t>(1, all.size() / probes);
    const double start = thread_seconds();
    trace(accelerator, kind, all, step);
    const double seconds = (thread_seconds() - start) * double(step);
    stride = std::max(stride, static_cast<size_t>(std::ceil(seconds / longest)));
  }
  return stride;
}

std::optional<TimedAccelerator::Cost> mean_cost(const TimedAccelerator& candidate,
                                                std::span<const Ray> rays) {
  QueryCost sum;
  size_t count = 0;
  for (size_t i = 0; i < rays.size(); i += candidate.stride, ++count) {
    const auto cost = candidate.accelerator->closest_cost(rays[i]);
    if (!cost) return {};
    sum.nodes += cost->nodes;
    sum.blocks += cost->blocks;
  }
  if (count == 0) return {};
  return TimedAccelerator::Cost{double(sum.nodes) / double(count), double(sum.blocks) / double(count)};
}

}  // namespace

std::vector<double> TimedAccelerator::mixed_seconds(size_t threads) const {
  std::vector<double> sum(seconds[threads][0].size());
  for (const auto& of_kind : seconds[threads])
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += of_kind[i];
  return sum;
}

double differing_per_million(const TimedAccelerator& a, const TimedAccelerator& b, const RayKind& kind,
                             std::span<const Ray> rays) {
  const auto triangle = [](const Accelerator& accelerator, const Ray& ray) {
    const auto hit = accelerator.closest(ray);
    return hit ? TriangleId{hit->instance, hit->primitive} : TriangleId{};
  };
  const size_t stride = std::max(a.stride, b.stride), count = (rays.size() + stride - 1) / stride;
  std::atomic<size_t> differing = 0;
  parallel_for(count, [&](size_t i) {
    const Ray& ray = rays[i * stride];
    const bool differs = kind.occlusion ? a.accelerator->occluded(ray) != b.accelerator->occluded(ray)
                                        : triangle(*a.accelerator, ray) != triangle(*b.accelerator, ray);
    if (differs) ++differing;
  });
  return 1e6 * double(differing) / double(std::max<size_t>(count, 1));
}

void time_accelerators(std::vector<TimedAccelerator>& candidates, const Geometry& geometry,
                       const PathRays& rays, int repetitions) {
  for (int i = 0; i < repetitions; ++i)
    for (TimedAccelerator& candidate : candidates) {
      candidate.accelerator.reset();
      candidate.accelerator = candidate.entry->build(geometry);
      candidate.build_seconds.push_back(candidate.accelerator->stats().build_seconds);
    }
  for (TimedAccelerator& candidate : candidates) {
    candidate.stride = choose_stride(*candidate.accelerator, rays);
    for (size_t k = 0; k < ray_kinds.size(); ++k)
      if (!ray_kinds[k].occlusion) candidate.cost[k] = mean_cost(candidate, rays.*ray_kinds[k].rays);
  }
  for (int i = 0; i < repetitions; ++i)
    for (const size_t threads : {0, 1})
      for (size_t k = 0; k < ray_kinds.size(); ++k)
        for (TimedAccelerator& candidate : candidates)
          candidate.seconds[threads][k].push_back(
              time_rays(candidate, ray_kinds[k], rays.*ray_kinds[k].rays, threads == 1));
}

}  // namespace vernier::apps
