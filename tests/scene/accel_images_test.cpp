// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "apps/validation/exact.h"
#include "integrators/render/render.h"
#include "scene/camera.h"
#include "scene/framing.h"
#include "scene/subject.h"
#include "tests/scene/accel_support.h"
#include "tests/support/test_scenes.h"
#include "vernier/scene.h"

// What a user sees of the choice of accelerator: nothing.

namespace vernier {
namespace {

constexpr int width = 96, height = 72;
const std::string reference = "bvh";
const char* const scenes[] = {"cornell_box", "layer_spheres", "sphere_grid", "two_spheres"};

struct View {
  Scene scene;
  Camera camera;

  View(const std::string& name, const std::string& accelerator, SceneDescription description)
      : scene(lit(std::move(description)), {accelerator}), camera(view_of(name, scene), width, height) {}

  /// Under a white sky.
  static SceneDescription lit(SceneDescription description) {
    auto picture = std::make_shared<Image>(2, 1, 3);
    std::fill(picture->values.begin(), picture->values.end(), 1.f);
    auto sky = std::make_shared<EnvironmentDescription>();
    sky->picture = std::move(picture);
    description.environment = std::move(sky);
    return description;
  }
  static CameraDescription view_of(const std::string& name, const Scene& scene) {
    const auto cameras = import_scene(file_of(name)).cameras;
    if (!cameras.empty()) return cameras.front();
    CameraDescription camera;
    camera.to_world = {{1, 0, 0}, {0, 0.8f, -0.6f}, {0, 0.6f, 0.8f}, {0, 0, 0}};
    const Subject subject(scene.geometry());
    return fit_camera(
        camera, [&](const Vec3f& direction) { return subject.farthest(direction); }, float(width) / height,
        0.05f);
  }
  static std::string file_of(const std::string& name) {
    return VERNIER_SOURCE_DIR "/tests/scenes/" + name + ".gltf";
  }
  View(const std::string& name, const std::string& accelerator)
      : View(name, accelerator, import_scene(file_of(name))) {}
};

/// Whether rounding may decide what the ray meets: it passes an edge, or two surfaces lie equally far.
bool is_within_rounding(const Scene& scene, const Ray& ray, const std::optional<SurfacePoint>& a,
                        const std::optional<SurfacePoint>& b) {
  const auto corners = [&](const SurfacePoint& p) {
    return scene.geometry().triangle(p.instance, p.primitive);
  };
  for (const auto* hit : {&a, &b})
    if (*hit && validation::is_near_boundary(ray, corners(**hit))) return true;
  if (!a || !b) return false;
  const auto x = validation::intersect_exactly(ray, corners(*a)),
             y = validation::intersect_exactly(ray, corners(*b));
  return std::abs(x.t - y.t) <= x.t_bound + y.t_bound;
}

class AcceleratorImages : public test::EveryAccelerator {};

TEST_P(AcceleratorImages, ShowTheSameTrianglesAtTheSameDepths) {
  for (const char* name : scenes) {
    const View mine(name, std::string(GetParam().name)), theirs(name, reference);
    int within_rounding = 0, met = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Ray ray = mine.camera.ray({float(x) + .5f, float(y) + .5f});
        const auto a = mine.scene.intersect(ray), b = theirs.scene.intersect(ray);
        met += b.has_value();
        const bool same = a.has_value() == b.has_value() &&
                          (!a || (a->instance == b->instance && a->primitive == b->primitive));
        if (!same) {
          ++within_rounding;
          ASSERT_TRUE(is_within_rounding(mine.scene, ray, a, b)) << name << " pixel " << x << ' ' << y;
        } else if (a) {
          const auto exact =
              validation::intersect_exactly(ray, mine.scene.geometry().triangle(a->instance, a->primitive));
          ASSERT_LE(std::abs(a->t - exact.t), exact.t_bound) << name << " pixel " << x << ' ' << y;
          ASSERT_LE(std::abs(b->t - exact.t), exact.t_bound) << name << " pixel " << x << ' ' << y;
        }
      }
    RecordProperty(std::string(name) + "_pixels_within_rounding", within_rounding);
    EXPECT_LE(within_rounding, width * height / 500) << name;
    EXPECT_GT(met, width * height / 10) << name;
  }
}

TEST_P(AcceleratorImages, ConvergeToTheSamePicture) {
  if (GetParam().name == "brute_force") return;  // minutes, on the spheres
  const auto integrator = make_integrator("path", {});
  RenderSettings options;
  options.width = width;
  options.height = height;
  options.limits.spp = 8;
  options.adaptive = false;
  const std::atomic<bool> stop = false;
  for (const char* name : scenes) {
    const View mine(name, std::string(GetParam().name)), theirs(name, reference);
    const RenderResult a = render(mine.scene, mine.camera, *integrator, options, stop);
    const RenderResult b = render(theirs.scene, theirs.camera, *integrator, options, stop);
    // The samples are the same, so all that differs are paths past boundaries: far less than the noise.
    double difference = 0, sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Vec3d d = a.film.pixel(x, y) - b.film.pixel(x, y), p = b.film.pixel(x, y);
        difference += dot(d, d);
        sum += dot(p, p);
      }
    EXPECT_LT(std::sqrt(difference / sum), b.error.rel_rmse) << name;
    EXPECT_GT(sum, 0) << name;
  }
}

FOR_EVERY_ACCELERATOR(AcceleratorImages);

}  // namespace
}  // namespace vernier
