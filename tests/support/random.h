// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>

#include "vernier/math.h"

namespace vernier::test {

/// Independent uniform numbers in [0, 1) from a fixed seed, the same on every platform. Tests draw from it
/// and not from Sampler, whose points are stratified: they are no independent samples, which goodness-of-fit
/// tests assume.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  float next1() { return float(engine_() >> 40) * 0x1p-24f; }
  Vec2f next2() {
    const float x = next1();
    return {x, next1()};
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace vernier::test
