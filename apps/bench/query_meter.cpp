// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/query_meter.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace vernier::apps {
namespace {

/// Of so many queries one is timed. No power of two, as samples come in those.
constexpr uint32_t timed_every = 13;
/// Longer ones were interrupted: no tree takes so long.
constexpr int64_t longest_nanoseconds = 200'000;

int64_t nanoseconds_now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

int64_t shortest_interval() {
  int64_t shortest = std::numeric_limits<int64_t>::max();
  for (int i = 0; i < 1000; ++i) {
    const int64_t start = nanoseconds_now();
    shortest = std::min(shortest, nanoseconds_now() - start);
  }
  return shortest;
}

}  // namespace

QueryMeter::QueryMeter(std::unique_ptr<Accelerator> answering, std::unique_ptr<Accelerator> own)
    : answering_(std::move(answering)), own_(std::move(own)), clock_nanoseconds_(shortest_interval()) {}

template <typename Query>
bool QueryMeter::measured(Kind kind, const Ray& ray, const Query& query) const {
  thread_local uint32_t turn = 0;
  Counters& counters = counters_[kind];
  const bool is_timed = ++turn % timed_every == 0;
  const int64_t start = is_timed ? nanoseconds_now() : 0;
  const bool met = query();
  if (is_timed) {
    const int64_t taken = nanoseconds_now() - start;
    if (taken <= longest_nanoseconds) {
      ++counters.timed;
      counters.nanoseconds += taken - clock_nanoseconds_;
    }
    if (const auto cost = kind == closest_hit ? own_->closest_cost(ray) : std::nullopt) {
      ++counters.looked;
      counters.nodes += cost->nodes;
      counters.blocks += cost->blocks;
    }
  }
  ++counters.count;
  counters.met += uint64_t(met);
  return met;
}

std::optional<RawHit> QueryMeter::closest(const Ray& ray) const {
  std::optional<RawHit> hit;
  measured(closest_hit, ray, [&] {
    hit = answering_->closest(ray);
    return hit.has_value();
  });
  return hit;
}

bool QueryMeter::occluded(const Ray& ray) const {
  return measured(occlusion, ray, [&] { return answering_->occluded(ray); });
}

bool QueryMeter::occluded(const Ray& ray, std::vector<RawHit>& passed) const {
  return measured(occlusion, ray, [&] { return answering_->occluded(ray, passed); });
}

void QueryMeter::all_hits(const Ray& ray, std::vector<RawHit>& sorted) const {
  measured(every_hit, ray, [&] {
    answering_->all_hits(ray, sorted);
    return !sorted.empty();
  });
}

QueryTotals QueryMeter::totals(Kind kind) const {
  const Counters& counters = counters_[kind];
  const auto mean = [](double sum, double count) { return count > 0 ? sum / count : 0; };
  return {counters.count, counters.met,
          1e-9 * mean(double(std::max<int64_t>(counters.nanoseconds, 0)), double(counters.timed)),
          mean(double(counters.nodes), double(counters.looked)),
          mean(double(counters.blocks), double(counters.looked))};
}

}  // namespace vernier::apps
