// SPDX-License-Identifier: Apache-2.0
#include "integrators/small_lamps.h"

#include "core/base/parallel.h"
#include "tests/support/effort.h"
#include "tests/support/pictures.h"
#include "tests/support/random.h"

// What the camera sees of lamps smaller than a pixel is the same light whether its own rays meet them or
// light paths bring it, and the noise of the former is gone.

namespace vernier::test {
namespace {

constexpr int size = 32;

/// Lamps of a third of a pixel and less, strewn and turned about the origin: some seen from behind,
/// some of both sides, one with a texture.
SceneBuilder string_of_lamps() {
  SceneBuilder builder;
  builder.texture(4, 1, {0, 255, 90, 30});
  Random random(7);
  const auto vec = [&] { return Vec3f(random.next1(), random.next1(), random.next1()) * 2 - Vec3f(1); };
  for (int i = 0; i < 12; ++i) {
    MaterialDescription material = emitter(20 + 10 * float(i));
    material.double_sided = i % 3 == 0;
    if (i == 4) material.emissive_texture.texture = 0;
    const Vec3f across = normalize(vec()), along = normalize(cross(across, vec()));
    const float side = 0.008f * float(1 + i % 4);
    builder.add(parallelogram(vec() * 0.8f, across * side, along * (3 * side)), material);
  }
  return builder;
}

struct View {
  const char* name;
  SceneBuilder scene = string_of_lamps();
  CameraDescription camera = camera_at({0, 0.3f, 3}, {0, 0, 0}, 0.7f);
  PixelFilter filter = {};
  Fog fog = {};
};

View among_walls() {
  View view{"among walls"};
  view.scene.add(box({-0.1f, -1, 0.8f}, {0.5f, 0.2f, 0.9f}), diffuse(0.5f))
      .add(parallelogram({-2, -2, -1.5f}, {4, 0, 0}, {0, 4, 0}), emitter(0.05f));
  return view;
}

/// A pane before half of them, through which camera samples go on seeing them.
View behind_a_pane() {
  MaterialDescription pane = glass(0);
  pane.thickness = 0;
  View view{"behind a pane"};
  view.scene.add(parallelogram({-2, 0, 1}, {4, 0, 0}, {0, 2, 0}), pane);
  return view;
}

/// A card with holes before them, masked or a veil: who passes it meets no surface.
View behind_a_card(AlphaMode mode) {
  MaterialDescription card = diffuse(0.5f);
  card.alpha_mode = mode;
  card.base_color_texture.texture = 1;
  View view{mode == AlphaMode::mask ? "behind a mask" : "behind a veil"};
  view.scene.alpha_texture(8, 1, {255, 0, 90, 200, 0, 160, 255, 40})
      .add(parallelogram({-2, -2, 1}, {4, 0, 0}, {0, 4, 0}), card);
  return view;
}
View behind_a_mask() { return behind_a_card(AlphaMode::mask); }
View behind_a_veil() { return behind_a_card(AlphaMode::blend); }

/// The camera too.
View under_water() {
  MaterialDescription water = glass(0);
  water.ior = 1.33f;
  water.attenuation_color = {0.4f, 0.7f, 0.9f};
  water.attenuation_distance = 2;
  View view{"under water"};
  view.scene.add(box({-5, -5, -5}, {5, 5, 5}), water);
  return view;
}

/// A board moves across them while the shutter is open.
View behind_a_moving_board() {
  MeshDescription board = parallelogram({-0.2f, -1, 0.9f}, {0.4f, 0, 0}, {0, 2, 0});
  for (const float aside : {-0.5f, 0.f, 0.5f}) {
    MeshShape shape;
    for (const Vec3f& at : board.positions) shape.positions.push_back(at + Vec3f(aside, 0, 0));
    board.moments.push_back(shape);
  }
  View view{"behind a moving board"};
  view.scene.add(board, diffuse(0.5f));
  return view;
}

View in_fog() {
  View view{"in fog"};
  view.fog = {0.3f, {0.9f, 0.7f, 0.5f}, 0.5f, 6};
  return view;
}

View through_a_lens() {
  View view{"through a lens"};
  view.camera.lens_radius = 0.15f;
  view.camera.focus_distance = 2.5f;
  return view;
}

View by_parallel_rays() {
  View view{"by parallel rays", string_of_lamps(), camera_at({0, 0.3f, 3}, {0, 0, 0}, 0.7f)};
  view.camera.kind = CameraDescription::Kind::orthographic;
  view.filter = {PixelFilter::Kind::box, 1.7f};  // no tails, in which camera samples find too little
  return view;
}

View all_around() {
  View view{"all around", string_of_lamps(), camera_at({0, 0, 0.1f}, {0, 0, -1}, 0.7f)};
  view.camera.kind = CameraDescription::Kind::panorama;
  view.filter = {PixelFilter::Kind::box, 2.5f};
  return view;
}

View by_a_moving_camera() {
  View view{"by a moving camera"};
  for (const float aside : {-0.2f, 0.f, 0.2f}) {
    Transform at = view.camera.to_world;
    at.origin.x += aside;
    view.camera.moments.push_back(at);
  }
  return view;
}

class SmallLampsSeen : public testing::TestWithParam<View (*)()> {};

constexpr std::array views{
    among_walls,    behind_a_pane,    behind_a_mask, behind_a_veil,      under_water,          in_fog,
    through_a_lens, by_parallel_rays, all_around,    by_a_moving_camera, behind_a_moving_board};

RenderSettings settings_of(const View& view, int spp) {
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.filter = view.filter;
  settings.adaptive = false;
  settings.integrator_options.max_depth = 1;  // what shines by itself
  settings.limits.spp = spp;
  return settings;
}

/// Means of squares of 8 x 8 pixels, then of the picture: of a single pixel at the edge of a lamp, camera
/// samples find too rarely anything for Welch's test.
std::vector<Samples> squares_of(const Scene& scene, const View& view, const RenderSettings& settings,
                                int renders, uint64_t first_seed) {
  constexpr int side = 8, squares = (size / side) * (size / side);
  const Camera camera(view.camera, size, size);
  const auto integrator = make_integrator(settings.integrator, settings.integrator_options);
  std::vector<std::array<Vec3d, squares + 1>> means(static_cast<size_t>(renders));
  parallel_for(means.size(), [&](size_t i) {
    RenderSettings seeded = settings;
    seeded.seed = first_seed + i;
    const std::atomic<bool> stop = false;
    const Film film = render(scene, camera, *integrator, seeded, stop).film;
    means[i].fill(Vec3d(0, 0, 0));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        means[i][size_t(y / side * (size / side) + x / side)] += film.pixel(x, y) / double(side * side);
        means[i][squares] += film.pixel(x, y) / double(size * size);
      }
  });
  std::vector<Samples> result(3 * (squares + 1));
  for (const auto& render : means)
    for (size_t i = 0; i < render.size(); ++i)
      for (int c = 0; c < 3; ++c) result[3 * i + size_t(c)].add(render[i][c]);
  return result;
}

// Welch's tests of every square, family significance 0.001.
TEST_P(SmallLampsSeen, LikeCameraSamplesSeeThem) {
  const double significance = sidak(1e-3, std::size(views));
  const View view = GetParam()();
  Scene scene = SceneBuilder(view.scene).build(), other = SceneBuilder(view.scene).build("bvh");
  scene.fill_air(view.fog);
  other.fill_air(view.fog);
  const Camera camera(view.camera, size, size);
  EXPECT_GE(SmallLamps(scene, camera, size, size).size(), 6u);
  double resolved = 0;
  const auto p_value = [&](uint64_t seed, uint64_t factor) {
    RenderSettings settings = settings_of(view, int(32 * factor));
    const auto brought = squares_of(scene, view, settings, 16, 1000 * seed);
    settings.integrator = "light";                                    // the camera's own rays see them
    settings.limits.spp = int(512 * factor) / std::min(thinning, 4);  // so rare are hits
    const auto met = squares_of(other, view, settings, 16, 1000 * seed + 500);
    resolved = resolution(brought, met, significance);
    return difference(brought, met);
  };
  EXPECT_TRUE(confirmed(significance, 1, p_value)) << view.name;
  EXPECT_LT(resolved, 0.1 * coarsening) << view.name;
}

INSTANTIATE_TEST_SUITE_P(Views, SmallLampsSeen, testing::ValuesIn(views));

/// A lamp of 1 x 2 mm that faces the camera four metres before it.
SceneBuilder one_lamp(const MaterialDescription& material) {
  return SceneBuilder().add(parallelogram({0.1f, 0.1f, 0}, {0.001f, 0, 0}, {0, 0.002f, 0}), material);
}
const CameraDescription before_it = camera_at({0, 0, 4}, {0, 0, 0}, 0.7f);

// The radiance of its pixel is the lamp's times the part of the pixel that it covers, known without noise.
TEST(SmallLamps, FillTheirPartOfThePixel) {
  const Scene scene = one_lamp(emitter(1000)).build();
  RenderSettings settings = settings_of({"one lamp"}, 2);
  const Camera camera(before_it, size, size);
  const auto integrator = make_integrator("path", settings.integrator_options);
  const std::atomic<bool> stop = false;
  const Film film = render(scene, camera, *integrator, settings, stop).film;
  const double pixel_side = 2 * 4 * std::tan(0.7 / 2) / size;  // in metres, where the lamp is
  double sum = 0;
  for (const float value : film.image().values) sum += double(value) / 3;
  EXPECT_NEAR(sum, 1000 * 0.001 * 0.002 / (pixel_side * pixel_side), 1e-4 * sum);
  const auto at = camera.project({0.1005f, 0.101f, 0});
  ASSERT_TRUE(at);
  EXPECT_FLOAT_EQ(film.image().pixel(int(at->x), int(at->y))[0], float(sum));
}

size_t lamps_of(const Scene& scene) { return SmallLamps(scene, {before_it, size, size}, size, size).size(); }

TEST(SmallLamps, AreThoseThatCameraSamplesHardlyMeet) {
  EXPECT_EQ(lamps_of(one_lamp(emitter(1000)).build()), 2u);  // triangles
  EXPECT_EQ(lamps_of(one_lamp(emitter(0.05f)).build()), 0u) << "too dim to matter";
  MaterialDescription flame = emitter(1000);
  flame.alpha_mode = AlphaMode::blend;
  flame.base_color.w = 0.5f;
  EXPECT_EQ(lamps_of(one_lamp(flame).build()), 0u) << "its coverage is up to camera samples";
  const MeshDescription globe = sphere({0, 0, 0}, 1, 64, 64);
  EXPECT_LT(lamps_of(SceneBuilder().add(globe, emitter(5)).build()), globe.triangles.size() / 100)
      << "a mesh that glows all over, but for its rim";
  EXPECT_EQ(
      lamps_of(SceneBuilder().add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), emitter(5)).build()), 0u)
      << "a large one";
  EXPECT_EQ(
      lamps_of(
          SceneBuilder().add(parallelogram({0, 0, 5}, {0.001f, 0, 0}, {0, 0.001f, 0}), emitter(5)).build()),
      0u)
      << "behind the camera";
}

}  // namespace
}  // namespace vernier::test
