// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/light_tree.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/sampling/warp.h"
#include "tests/support/effort.h"
#include "tests/support/random.h"

// Bounds of groups of lights, and the tree's choice among very many and very unequal ones.

namespace vernier::test {
namespace {

Vec3f random_direction(Random& random) { return sample_sphere(random.next2()); }

/// `axis`, the same turned by up to `most` radians, or the opposite of either.
Vec3f near_axis(const Vec3f& axis, float most, Random& random) {
  const Vec3f turned = normalize(axis + random_direction(random) * (most * random.next1()));
  return random.next1() < 0.5f ? turned : -turned;
}

/// Whether emission may lie along `w`, by the cone's definition.
bool covers(const LightBounds& bounds, const Vec3d& w, double spread_within) {
  const auto angle = [](const Vec3d& a, const Vec3d& b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
  };
  const double spread = std::acos(std::clamp(double(bounds.cos_spread), -1.0, 1.0));
  const Vec3d axis(bounds.axis);
  return angle(axis, w) + spread_within <= spread + 1e-9 ||
         (bounds.two_sided && angle(-axis, w) + spread_within <= spread + 1e-9);
}

LightBounds cone(const Vec3f& axis, float spread, bool two_sided = false) {
  LightBounds bounds;
  bounds.box.add(Vec3f(0, 0, 0));
  bounds.axis = axis;
  bounds.cos_spread = std::cos(spread);
  bounds.power = 1;
  bounds.two_sided = two_sided;
  return bounds;
}

TEST(LightBounds, OfAGroupContainThoseOfItsMembers) {
  Random random(5);
  for (int trial = 0; trial < 20'000; ++trial) {
    const Vec3f axis = random_direction(random);
    const float most = std::pow(10.f, -8 * random.next1()) * 4;
    std::vector<LightBounds> members;
    LightBounds group;
    for (int i = 0; i < 2 + trial % 7; ++i) {
      const float spread = random.next1() < 0.5f ? 0 : std::pow(10.f, -5 * random.next1()) * pi;
      members.push_back(cone(near_axis(axis, most, random), spread, random.next1() < 0.3f));
      group = merge(group, members.back());
    }
    for (const LightBounds& member : members) {
      const double spread = std::acos(double(member.cos_spread));
      ASSERT_TRUE(group.cos_spread <= -1 || covers(group, Vec3d(member.axis), spread)) << trial;
      if (member.two_sided) {
        ASSERT_TRUE(group.cos_spread <= -1 || covers(group, -Vec3d(member.axis), spread)) << trial;
      }
    }
  }
}

TEST(LightBounds, OppositeAxesCoverTheSphere) {
  for (const Vec3f& axis : {Vec3f(0, 1, 0), normalize(Vec3f(0.3f, 0.8f, 0.52f))})
    EXPECT_EQ(merge(cone(axis, 0), cone(-axis, 0)).cos_spread, -1);
}

TEST(LightBounds, EqualAxesStayNarrow) {
  const Vec3f axis = normalize(Vec3f(0.3f, 0.8f, 0.52f));
  LightBounds group = cone(axis, 0);
  for (int i = 0; i < 100; ++i) group = merge(group, cone(axis, 0));
  EXPECT_EQ(group.cos_spread, 1);
  EXPECT_EQ(group.axis, axis);
  EXPECT_GT(merge(group, cone(normalize(axis + Vec3f(0.1f, 0, 0)), 0)).cos_spread, 0.99f);
}

TEST(LightBounds, WithoutADirectionCoverTheSphere) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Vec3f& axis : {Vec3f(0, 0, 0), Vec3f(nan, 0, 0), Vec3f(1e-30f, 0, 0)})
    EXPECT_EQ(merge(cone(axis, 0), cone({0, 1, 0}, 0)).cos_spread, -1);
}

LightTree tree_over(const std::vector<LightBounds>& lights) {
  return {lights.size(), [&](size_t i) { return lights[i]; }};
}

/// Length of the interval of u about `u` in which `pick` gives what it gives there, of expected length
/// `prob`.
template <typename Pick>
double measured_probability(double u, double prob, const Pick& pick) {
  const auto chosen = pick(u);
  const auto edge = [&](double inside, double outside) {
    outside = std::clamp(outside, 0.0, 0x1.fffffffffffffp-1);
    if (pick(outside) == chosen) return outside;
    for (int i = 0; i < 60; ++i) {
      const double middle = (inside + outside) / 2;
      (pick(middle) == chosen ? inside : outside) = middle;
    }
    return inside;
  };
  return edge(u, u + 1.5 * prob) - edge(u, u - 1.5 * prob);
}

/// Lights over a square of that many a side, powers from 1e-6 to 1e6.
std::vector<LightBounds> field(int side) {
  Random random(19);
  std::vector<LightBounds> lights;
  for (int i = 0; i < side * side; ++i) {
    LightBounds light = cone({0, 1, 0}, pi);
    light.box = {};
    const int row = i / side, column = i % side;
    light.box.add(Vec3f(float(column), random.next1(), float(row)));
    light.power = std::pow(10.f, 12 * random.next1() - 6);
    lights.push_back(light);
  }
  return lights;
}

// Each leaf of a deep tree is picked as often as is told. That u is stretched at each level takes digits from
// it in proportion: what is left of its 53 is told by 2^-52 over the probability.
TEST(LightTree, GivesEachOfVeryManyLightsItsProbability) {
  const std::vector<LightBounds> lights = field(300);
  const LightTree tree = tree_over(lights);
  const LightReceiver receiver{{17.3f, -2, 110.8f}, {0, 1, 0}};
  const auto pick = [&](double u) { return tree.sample(receiver, u).light; };
  Random random(2);
  double rarest = 1;
  for (int i = 0; i < 3000; ++i) {
    // A light anywhere, however rare: start at any u and go to lights of the same corner of the tree.
    const double u = random.next1() + random.next1() * 0x1p-24;
    const auto [light, prob] = tree.sample(receiver, u);
    ASSERT_DOUBLE_EQ(prob, tree.prob(receiver, light));
    ASSERT_NEAR(measured_probability(u, prob, pick), prob, 1e-12 + 0x1p-50) << prob;
    rarest = std::min(rarest, prob);
  }
  EXPECT_LT(rarest, 1e-7);
}

// Two lights a hundred million times as strong as each other.
TEST(LightTree, GivesAVeryFaintLightItsProbability) {
  for (const float power : {1e-8f, 1e-11f}) {
    std::vector<LightBounds> lights{cone({0, 1, 0}, pi), cone({0, 1, 0}, pi)};
    lights[0].power = power;
    lights[1].box = {};
    lights[1].box.add(Vec3f(0.1f, 0, 0));
    const LightTree tree = tree_over(lights);
    const LightReceiver receiver{{0, -3, 0}, {0, 1, 0}};
    const double prob = tree.prob(receiver, 0);
    EXPECT_NEAR(prob, power, 0.1 * power);
    const auto pick = [&](double u) { return tree.sample(receiver, u).light; };
    const double u = pick(0) == 0 ? prob / 2 : 1 - prob / 2;
    ASSERT_EQ(pick(u), 0u);
    EXPECT_NEAR(measured_probability(u, prob, pick), prob, 1e-4 * prob);
  }
}

TEST(LightBounds, AWideConeTakesInNarrowOnesAsItIs) {
  const Vec3f axis = normalize(Vec3f(0.3f, 0.8f, 0.52f)), aside = normalize(cross(axis, {1, 0, 0}));
  const LightBounds wide = cone(axis, 0.5f);
  const LightBounds within = cone(normalize(axis + aside * 0.2f), 0.1f), across = cone(aside, 0.1f);
  EXPECT_EQ(merge(wide, within).axis, axis);
  EXPECT_EQ(merge(within, wide).axis, axis);
  EXPECT_NEAR(merge(wide, within).cos_spread, wide.cos_spread, 1e-6);
  EXPECT_NE(merge(wide, across).axis, axis);
}

TEST(LightTree, OfManyLightsIsTheSameForAnyNumberOfThreads) {
  // More than are worth a task of their own.
  Random random(9);
  std::vector<LightBounds> lights;
  for (int i = 0; i < 30'000; ++i) {
    LightBounds& light = lights.emplace_back(cone(random_direction(random), 0));
    light.box = {};
    light.box.add(10 * random.next1() * random_direction(random));
    light.power = random.next1();
  }
  const auto picks = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    const LightTree tree = tree_over(lights);
    Random choices(11);
    std::vector<std::pair<uint32_t, double>> list;
    for (int i = 0; i < 2000; ++i) {
      const LightReceiver receiver{20 * choices.next1() * random_direction(choices),
                                   random_direction(choices)};
      const auto [light, prob] = tree.sample(receiver, choices.next1());
      list.emplace_back(light, prob);
      if (prob > 0) {
        EXPECT_NEAR(tree.prob(receiver, light), prob, 1e-9 * prob);
      }
    }
    return list;
  };
  const auto expected = picks(1);
  EXPECT_EQ(picks(2), expected);
  EXPECT_EQ(picks(7), expected);
}

}  // namespace
}  // namespace vernier::test
