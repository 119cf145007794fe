// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/sampling/warp.h"
#include "scene/lights/light_node.h"
#include "scene/lights/light_split.h"
#include "tests/support/random.h"

// What a light tree is built from: ranges of lights, their bounds, their splits, and the nodes that keep
// them.

namespace vernier::test {
namespace {

/// Lights of a patch of a surface whose normals vary by so much, some of them two-sided, cones, or both.
std::vector<PlacedLight> any_lights(size_t count, float varied, bool are_plain, Random& random) {
  const Vec3f axis = sample_sphere(random.next2());
  std::vector<PlacedLight> lights(count);
  for (size_t i = 0; i < count; ++i) {
    LightBounds& bounds = lights[i].bounds;
    const Vec3f place = sample_sphere(random.next2()) * random.next1();
    bounds.box.add(place);
    bounds.box.add(place + sample_sphere(random.next2()) * 0.01f);
    bounds.axis = normalize(axis + varied * sample_sphere(random.next2()));
    bounds.power = 0.1f + random.next1();
    if (!are_plain && random.next1() < 0.3f) bounds.axis = -bounds.axis;
    bounds.two_sided = !are_plain && random.next1() < 0.5f;
    if (!are_plain && random.next1() < 0.2f) bounds.cos_spread = 1 - square(varied) * random.next1();
    if (!are_plain && random.next1() < 0.2f) bounds.cos_emission = 2 * random.next1() - 1;
    lights[i].light = uint32_t(i);
  }
  return lights;
}

double angle_between(const Vec3d& a, const Vec3d& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// To within what the rounding of a tree's nodes allows for.
void expect_within(const LightBounds& inner, const LightBounds& outer) {
  EXPECT_TRUE(outer.box.contains(inner.box.lower) && outer.box.contains(inner.box.upper));
  EXPECT_GE(inner.cos_emission, outer.cos_emission);
  EXPECT_TRUE(outer.two_sided || !inner.two_sided);
  if (outer.cos_spread <= -1) return;
  const double room = std::acos(double(outer.cos_spread)) + 1e-4,
               spread = std::acos(double(inner.cos_spread));
  const double apart = angle_between(Vec3d(inner.axis), Vec3d(outer.axis));
  EXPECT_LE(spread + (outer.two_sided ? std::min(apart, double(pi) - apart) : apart), room);
}

TEST(LightRange, BoundsContainEveryLight) {
  Random random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const float varied = std::pow(10.f, -5 * random.next1()) * 2;
    auto lights = any_lights(2 + size_t(trial) % 40, varied, trial % 2 == 0, random);
    const LightBounds all = bounds_of(range_of(lights));
    float power = 0;
    for (const PlacedLight& light : lights) {
      expect_within(light.bounds, all);
      power += light.bounds.power;
    }
    EXPECT_NEAR(all.power, power, 1e-4f * power);
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
  }
}

// The cone is that of the patch, not much wider: for a plain patch its normals vary by no more than this.
TEST(LightRange, BoundsAreNarrowWhereLightsAre) {
  Random random(4);
  for (const float varied : {1e-3f, 0.01f, 0.1f, 0.3f}) {
    auto lights = any_lights(1000, varied, true, random);
    EXPECT_LT(std::acos(bounds_of(range_of(lights)).cos_spread), 1.3f * varied) << varied;
  }
}

/// Of fewer lights than buckets, of some blocks of them, and of lights in one place.
TEST(LightRange, SplitsIntoTwoThatHoldAllLights) {
  Random random(5);
  for (const size_t count : {2u, 3u, 7u, 12u, 13u, 100u, 8192u, 8193u, 40'000u})
    for (const bool are_apart : {true, false}) {
      auto lights = any_lights(count, 1, false, random);
      if (!are_apart)
        for (PlacedLight& light : lights) light.bounds.box = lights[0].bounds.box;
      const auto [below, above] = split(range_of(lights));
      ASSERT_GT(below.size(), 0u);
      ASSERT_GT(above.size(), 0u);
      ASSERT_EQ(below.lights.data(), lights.data());
      ASSERT_EQ(above.lights.data(), lights.data() + below.size());
      ASSERT_EQ(below.size() + above.size(), count);
      std::set<uint32_t> found;
      for (const PlacedLight& light : lights) found.insert(light.light);
      EXPECT_EQ(found.size(), count);
      for (const LightRange* part : {&below, &above}) {
        const LightBounds bounds = bounds_of(*part);
        for (const PlacedLight& light : part->lights) expect_within(light.bounds, bounds);
        const LightGroup anew = range_of(part->lights).group;
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_EQ(part->group.lower[axis], anew.lower[axis]);
          EXPECT_EQ(part->group.center_upper[axis], anew.center_upper[axis]);
        }
      }
      ASSERT_FALSE(HasFailure()) << count << " lights";
    }
}

// Two heaps far apart, and two groups that face apart in one heap.
TEST(LightRange, SplitsWhereLightsDiffer) {
  Random random(6);
  for (const bool differ_in_place : {true, false}) {
    auto lights = any_lights(200, 0.01f, true, random);
    for (size_t i = 0; i < lights.size(); ++i) {
      LightBounds& bounds = lights[i].bounds;
      const bool is_second = i % 2 == 1;
      bounds.box = {};
      bounds.box.add(Vec3f(is_second ? 1.f : 0.f, 0, 0) + sample_sphere(random.next2()) * 0.4f);
      if (differ_in_place && is_second)
        bounds.box = {bounds.box.lower + Vec3f(9), bounds.box.upper + Vec3f(9)};
      if (!differ_in_place) bounds.axis = is_second ? Vec3f(1, 0, 0) : Vec3f(0, 1, 0);
    }
    const auto [below, above] = split(range_of(lights));
    for (const LightRange* part : {&below, &above}) {
      const auto seconds = std::count_if(part->lights.begin(), part->lights.end(),
                                         [](const PlacedLight& light) { return light.light % 2 == 1; });
      EXPECT_TRUE(seconds == 0 || size_t(seconds) == part->size()) << differ_in_place << " " << seconds;
    }
  }
}

// What a node keeps in few bits stays an upper estimate: whatever a light of the group may send in its
// direction counts.
TEST(LightNode, FindsWhateverItsLightsReach) {
  Random random(7);
  for (int trial = 0; trial < 3000; ++trial) {
    const float varied = std::pow(10.f, -4 * random.next1());
    auto lights = any_lights(1 + size_t(trial) % 9, varied, trial % 2 == 0, random);
    LightNode node;
    const int slot = trial % LightNode::width;
    node.set(slot, bounds_of(range_of(lights)));
    for (int i = 0; i < 30; ++i) {
      const LightBounds& light = lights[size_t(i) % lights.size()].bounds;
      // Along the rim of what it lights, or anywhere in it.
      const float cosine = lerp(square(square(random.next1())), light.cos_emission, 1);
      const float turn = 2 * pi * random.next1(), sine = safe_sqrt(1 - square(cosine));
      const Vec3f aside = normalize(cross(light.axis, sample_sphere(random.next2())));
      const Vec3f w =
          light.axis * cosine + (aside * std::cos(turn) + cross(light.axis, aside) * std::sin(turn)) * sine;
      LightReceiver receiver;
      receiver.position = light.box.center() + w * std::pow(10.f, 3 - 4 * random.next1());
      if (i % 2 == 0) receiver.normal = -w;
      const Float8 weights = node.importance(receiver);
      for (int other = 0; other < LightNode::width; ++other) {
        ASSERT_EQ(weights[other] > 0, other == slot) << "trial " << trial;
      }
    }
  }
}

}  // namespace
}  // namespace vernier::test
