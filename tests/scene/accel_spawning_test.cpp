// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/spawning.h"
#include "scene/accel/bvh.h"
#include "tests/scene/accel_support.h"

namespace vernier {
namespace {

using namespace validation;
using test::EveryAccelerator;

constexpr uint64_t rays = 20'000;

std::vector<SpawnCase> spawn_cases() {
  std::vector<SpawnCase> cases;
  for (const bool instanced : {false, true}) {
    for (const float scale : {1e-6f, 1e-3f, 1.f, 1e3f, 1e6f}) cases.push_back({scale, 0, instanced, false});
    for (const float offset : {1e3f, 1e5f, 1e7f}) cases.push_back({1, offset, instanced, false});
  }
  return cases;
}

class SpawnedRays : public EveryAccelerator {};

TEST_P(SpawnedRays, DoesNotHitWhatARayLeaves) {
  for (const SpawnCase& c : spawn_cases()) {
    const Count hits = self_hits(GetParam().build, c, rays, 1);
    EXPECT_EQ(hits.events, 0u) << "scale " << c.scale << " offset " << c.offset << " instanced "
                               << c.instanced;
    EXPECT_GT(hits.trials, rays / 10);
  }
}

// What the offset of the origin does by itself. No bound on rounding covers slivers, so one of the scenes, of
// 250 rays each, may be lost. Without the share of the triangle's size, which coordinate planes need, 2,200
// to 2,300 of the 20,000 are with the watertight test.
TEST_P(SpawnedRays, SeldomHitsACopyOfWhatARayLeaves) {
  constexpr uint64_t most = 250;
  for (SpawnCase c : spawn_cases()) {
    c.copied = true;
    const Count hits = self_hits(GetParam().build, c, rays, 1);
    EXPECT_LE(hits.events, most) << "scale " << c.scale << " offset " << c.offset << " instanced "
                                 << c.instanced;
    EXPECT_GT(hits.trials, rays / 10);
  }
}

TEST_P(SpawnedRays, KeepsGapsOfSixteenUlps) {
  for (const SpawnCase& c : spawn_cases()) {
    if (c.instanced) continue;
    EXPECT_EQ(missed_gaps(GetParam().build, c, 16, rays, 2).events, 0u)
        << "scale " << c.scale << " offset " << c.offset;
  }
}

FOR_EVERY_ACCELERATOR(SpawnedRays);

// Mutation: a fixed epsilon must fail one of the pair, whatever the scale.
TEST(SpawningChecks, CatchAFixedEpsilon) {
  const auto fails = [](float scale, float offset) {
    const SpawnCase c{scale, offset, false, false, Spawn::fixed_epsilon};
    return self_hits(build_bvh, c, rays, 1).events > 0 || missed_gaps(build_bvh, c, 16, rays, 2).events > 0;
  };
  EXPECT_TRUE(fails(1, 0));
  EXPECT_TRUE(fails(1, 1e5f));
  EXPECT_TRUE(fails(1e-6f, 0));
  EXPECT_TRUE(fails(1e6f, 0));
}

}  // namespace
}  // namespace vernier
