// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <memory>

#include "scene/accel/accelerator.h"

namespace vernier::apps {

/// What queries of one kind came to.
struct QueryTotals {
  uint64_t count = 0;
  uint64_t met = 0;  ///< that met something
  double seconds_each = 0;
  double nodes_each = 0, blocks_each = 0;  ///< as QueryCost counts them, of the own tree
};

/// Answers as another accelerator does, and keeps count. Every so-manieth query is timed and asks the own
/// tree what it looks at, so that the others take little more than they would.
class QueryMeter : public Accelerator {
 public:
  enum Kind { closest_hit, occlusion, every_hit };
  static constexpr size_t kinds = 3;

  /// `own` must tell closest_cost().
  QueryMeter(std::unique_ptr<Accelerator> answering, std::unique_ptr<Accelerator> own);

  std::optional<RawHit> closest(const Ray& ray) const override;
  bool occluded(const Ray& ray) const override;
  bool occluded(const Ray& ray, std::vector<RawHit>& passed) const override;
  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override;
  AcceleratorStats stats() const override { return answering_->stats(); }

  /// So far. Not while it is asked.
  QueryTotals totals(Kind kind) const;

 private:
  struct Counters {
    std::atomic<uint64_t> count = 0, met = 0, timed = 0, nodes = 0, blocks = 0, looked = 0;
    std::atomic<int64_t> nanoseconds = 0;
  };
  template <typename Query>
  bool measured(Kind kind, const Ray& ray, const Query& query) const;

  std::unique_ptr<Accelerator> answering_, own_;
  int64_t clock_nanoseconds_;  ///< that reading the clock twice takes
  mutable std::array<Counters, kinds> counters_;
};

}  // namespace vernier::apps
