// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "scene/camera.h"
#include "tests/support/pictures.h"

// What of the world, and of a texture, a pixel shows.

namespace vernier::test {
namespace {

using Kind = CameraDescription::Kind;

CameraDescription camera_of(Kind kind) {
  CameraDescription description;
  description.kind = kind;
  description.yfov = 1.4f;
  description.xmag = 3, description.ymag = 2;
  description.to_world.origin = {0.5f, 1, 4};
  return description;
}

/// The area of a cone's cross section is that of a surface whose picture is one pixel, as light paths have
/// it.
TEST(PixelCone, HasTheAreaThatAPixelShows) {
  for (const Kind kind : {Kind::perspective, Kind::orthographic, Kind::panorama}) {
    const Camera camera(camera_of(kind), 300, 200);
    for (const Vec2f& raster : {Vec2f(150, 100), Vec2f(20, 30), Vec2f(299, 199), Vec2f(3, 150)})
      for (const float t : {0.7f, 25.f}) {
        const auto sight = camera.sight(camera.ray(raster).at(t), {0, 0}, middle_of_shutter);
        ASSERT_TRUE(sight);
        EXPECT_NEAR(square(camera.pixel_cone(raster).width_at(t)) * sight->area, 1, 2e-4)
            << int(kind) << " " << raster.x << " " << raster.y;
      }
  }
}

/// Second moments of a parallelogram, times 12.
struct Moments {
  double xx, xy, yy;
};
Moments moments_of(const UvArea& area) {
  const auto& [p, q] = area;
  return {p.x * p.x + q.x * q.x, p.x * p.y + q.x * q.y, p.y * p.y + q.y * q.y};
}

/// A ground with two more sets of texture coordinates: sheared ones, and none.
MeshDescription ground(float size) {
  MeshDescription mesh = parallelogram({-size, 0, size}, {2 * size, 0, 0}, {0, 0, -2 * size});
  for (const Vec2f& uv : mesh.texcoords[0]) mesh.texcoords[1].emplace_back(3 * uv.x + uv.y + 7, -2 * uv.y);
  mesh.more_texcoords.emplace_back();
  for (const Vec2f& uv : mesh.texcoords[0]) mesh.more_texcoords[0].emplace_back(uv.y, uv.x);
  mesh.more_texcoords.emplace_back();
  return mesh;
}

/// What the middle pixel shows in a texture by its footprint, and by the rays through its sides.
void expect_footprint(const Scene& scene, const Camera& camera, int set, uint32_t instance) {
  const Vec2f raster(50, 50);
  const auto uv_at = [&](const Vec2f& at) {
    const auto hit = scene.intersect(camera.ray(at));
    EXPECT_TRUE(hit && hit->instance == instance);
    return scene.geometry().attributes(*hit).texcoord(set);
  };
  const float h = 0.5f;
  const auto side = [&](const Vec2f& d) { return (uv_at(raster + d * h) - uv_at(raster - d * h)) / (2 * h); };
  const Moments exact = moments_of({side({1, 0}), side({0, 1})});

  const Ray ray = camera.ray(raster);
  auto hit = scene.intersect(ray);
  ASSERT_TRUE(hit);
  hit->footprint = camera.pixel_cone(raster).width_at(hit->t);
  const SurfaceAttributes attributes = scene.geometry().attributes(*hit, -ray.direction);
  ASSERT_TRUE(attributes.has_footprint);
  const Moments found = moments_of(attributes.texcoord_area(set));
  const double scale = exact.xx + exact.yy;
  EXPECT_NEAR(found.xx / scale, exact.xx / scale, 0.02) << "set " << set;
  EXPECT_NEAR(found.xy / scale, exact.xy / scale, 0.02) << "set " << set;
  EXPECT_NEAR(found.yy / scale, exact.yy / scale, 0.02) << "set " << set;
}

/// In the middle of the picture, where pixels are square, a cone's footprint is that of the pixel: for every
/// set of texture coordinates, at every slant, however the mesh is placed.
TEST(Footprint, IsWhatAPixelShows) {
  const Transform small{{0.25f, 0, 0}, {0, 1, 0}, {0, 0, 0.5f}, {0, 0, 0}};
  const Transform mirrored{{-1, 0, 0.4f}, {0, 1, 0}, {0, 0, 2}, {0, 0, 0}};
  for (const Transform& to_world : {Transform{}, small, mirrored})
    for (const bool is_shared : {false, true}) {
      SceneBuilder builder;
      MeshDescription mesh = ground(60);
      for (Triangle& t : mesh.triangles)
        if (to_world.determinant() < 0) std::swap(t[1], t[2]);
      SceneDescription description = builder.add(mesh, diffuse(0.5f), to_world).description();
      if (is_shared) {
        description.instances.push_back(description.instances[0]);
        description.instances[1].to_world.origin.y = -9;
      }
      const Scene scene(std::move(description), {});
      for (const float height : {30.f, 5.f, 1.f})
        for (const Kind kind : {Kind::perspective, Kind::orthographic}) {
          CameraDescription camera = camera_of(kind);
          camera.yfov = 0.2f, camera.xmag = camera.ymag = 2;
          camera.to_world = camera_at({1, height, 6}, {-3, 0, -14}, 0).to_world;
          for (const int set : {0, 1, 2}) expect_footprint(scene, Camera(camera, 100, 100), set, 0);
        }
    }
}

TEST(Footprint, OfWhatMovesIsThatOfItsTime) {
  MeshDescription mesh = parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  InstanceDescription instance;
  instance.moments = {Transform{}, Transform{{3, 0, 0}, {0, 3, 0}, {0, 0, 1}, {0, 0, 0}}};
  instance.to_world = Transform{{2, 0, 0}, {0, 2, 0}, {0, 0, 1}, {0, 0, 0}};
  SceneDescription description = SceneBuilder().add(mesh, diffuse(0.5f)).description();
  instance.mesh = description.instances[0].mesh;
  instance.material = description.instances[0].material;
  description.instances[0] = instance;
  const Scene scene(std::move(description), {});
  for (const float time : {0.f, 0.5f, 1.f}) {
    Ray ray = ray_through({0.3f, 0.2f, 5}, {0.3f, 0.2f, 0});
    ray.time = time;
    auto hit = scene.intersect(ray);
    ASSERT_TRUE(hit);
    hit->footprint = 0.1f;
    const Moments found = moments_of(scene.geometry().attributes(*hit, ray.direction).texcoord_area(0));
    const double side = 0.1 / (2 * (1 + 2 * time));
    EXPECT_NEAR(found.xx, side * side, 1e-7);
    EXPECT_NEAR(found.yy, side * side, 1e-7);
  }
}

TEST(Footprint, IsAPointWhereThereAreNoTextureCoordinates) {
  const Scene scene(SceneBuilder().add(ground(400), diffuse(0.5f)).description(), {});
  auto hit = scene.intersect(ray_through({0, 3, 0}, {0, 0, -3}));
  ASSERT_TRUE(hit);
  EXPECT_FALSE(scene.geometry().attributes(*hit, {0, 1, 0}).has_footprint) << "nobody asked";
  hit->footprint = 0.1f;
  const SurfaceAttributes attributes = scene.geometry().attributes(*hit, {0, 1, 0});
  ASSERT_TRUE(attributes.has_footprint);
  for (const int set : {3, 9})
    for (const Vec2f& side : attributes.texcoord_area(set)) EXPECT_EQ(side, Vec2f(0, 0));
}

}  // namespace
}  // namespace vernier::test
