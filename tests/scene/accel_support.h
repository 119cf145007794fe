// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "apps/validation/soup.h"
#include "scene/accel/accelerator.h"

namespace vernier {

/// GoogleTest would print bytes.
inline void PrintTo(const AcceleratorEntry& entry, std::ostream* out) { *out << entry.name; }

}  // namespace vernier

namespace vernier::test {

/// A test that every line of accelerators() goes through.
class EveryAccelerator : public testing::TestWithParam<AcceleratorEntry> {
 protected:
  std::unique_ptr<Accelerator> build(const validation::TriangleSoup& soup) const {
    return GetParam().build(soup.geometry());
  }
};

inline std::string accelerator_test_name(const testing::TestParamInfo<AcceleratorEntry>& info) {
  std::string name(info.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

inline Ray make_ray(const Vec3f& origin, const Vec3f& direction, float t_min = 0,
                    float t_max = std::numeric_limits<float>::infinity()) {
  return {origin, t_min, direction, t_max};
}

/// Bit for bit, so that NaN equals itself.
inline bool same_bits(const RawHit& a, const RawHit& b) {
  return a.t == b.t && a.u == b.u && a.v == b.v && a.instance == b.instance && a.primitive == b.primitive;
}

inline bool same_bits(const std::optional<RawHit>& a, const std::optional<RawHit>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
}

}  // namespace vernier::test

#define FOR_EVERY_ACCELERATOR(suite)                                                        \
  INSTANTIATE_TEST_SUITE_P(Accelerators, suite, testing::ValuesIn(vernier::accelerators()), \
                           vernier::test::accelerator_test_name)
