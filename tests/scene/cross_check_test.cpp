// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/cross_check.h"

#include "tests/support/random.h"
#include "tests/support/test_scenes.h"

namespace vernier::test {
namespace {

/// Misses the triangles of one number.
class Forgetful : public Accelerator {
 public:
  Forgetful(std::unique_ptr<Accelerator> right, uint32_t forgotten)
      : right_(std::move(right)), forgotten_(forgotten) {}

  std::optional<RawHit> closest(const Ray& ray) const override {
    std::vector<RawHit> hits;
    all_hits(ray, hits);
    return hits.empty() ? std::nullopt : std::optional(hits.front());
  }
  bool occluded(const Ray& ray) const override { return closest(ray).has_value(); }
  bool occluded(const Ray& ray, std::vector<RawHit>&) const override { return occluded(ray); }
  void all_hits(const Ray& ray, std::vector<RawHit>& sorted) const override {
    right_->all_hits(ray, sorted);
    std::erase_if(sorted, [&](const RawHit& hit) { return hit.primitive == forgotten_; });
  }
  AcceleratorStats stats() const override { return {}; }

 private:
  std::unique_ptr<Accelerator> right_;
  uint32_t forgotten_;
};

std::unique_ptr<Accelerator> build(const Scene& scene, const char* name) {
  for (const auto& entry : accelerators())
    if (entry.name == name) return entry.build(scene.accelerated_geometry());
  return nullptr;
}

/// Half of the rays aim at corners and edges.
Ray some_ray(Random& random, const Scene& scene, uint32_t triangles) {
  const auto between = [&](float low, float high) { return lerp(random.next1(), low, high); };
  Ray ray;
  ray.origin = {between(-3, 3), between(-3, 3), between(-3, 3)};
  const auto corners = scene.geometry().triangle(0, uint32_t(between(0, float(triangles))));
  const float along = random.next1();
  const Vec3f edge = corners[0] + (corners[1] - corners[0]) * (along < 0.5f ? 0.f : along);
  ray.direction =
      random.next1() < 0.5f ? edge - ray.origin : Vec3f(between(-1, 1), between(-1, 1), between(-1, 1));
  return ray;
}

TEST(CrossCheck, ExcusesRoundingOnly) {
  const Scene scene = SceneBuilder().add(sphere({0.1f, 0.2f, 0.3f}, 1, 12, 24), plastic(0.5f)).build();
  const auto triangles = uint32_t(scene.geometry().triangle_count(0));
  const validation::CrossCheck right(scene.geometry(), build(scene, "bvh"), build(scene, "embree-fast"),
                                     build(scene, "bvh"));
  const validation::CrossCheck wrong(scene.geometry(), build(scene, "bvh"),
                                     std::make_unique<Forgetful>(build(scene, "bvh"), triangles / 2),
                                     build(scene, "bvh"));
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    const Ray ray = some_ray(random, scene, triangles);
    for (const auto* check : {&right, &wrong}) {
      check->closest(ray);
      check->occluded(ray);
    }
  }
  EXPECT_EQ(right.result().rays, 40000u);
  EXPECT_EQ(right.result().real, 0u);
  EXPECT_GT(right.result().at_boundary, 100u);
  EXPECT_GT(wrong.result().real, 0u);
  ASSERT_FALSE(wrong.result().examples.empty());
  for (const auto& example : wrong.result().examples)
    EXPECT_EQ(example.other.value().primitive, triangles / 2);
}

}  // namespace
}  // namespace vernier::test
