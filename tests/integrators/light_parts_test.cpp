// SPDX-License-Identifier: Apache-2.0
#include "integrators/light_parts.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/parallel.h"
#include "integrators/render/checkpoint.h"
#include "integrators/render/layers.h"
#include "tests/support/effort.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/session.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

struct Lit {
  bool panel = true, lamp = true, sky = true;
};

/// Every kind of surface, lit by an area light, a lamp and a sky; the camera at (0, 0.5, 3) looks along -z.
SceneDescription room(const Lit& lit) {
  SceneBuilder builder;
  MaterialDescription panel = emitter(lit.panel ? 6.f : 0.f);
  panel.name = "panel";
  MaterialDescription pane = glass(0);
  pane.thickness = 0;
  MaterialDescription leaf = diffuse(0.8f);
  leaf.diffuse_transmission = 0.5f;
  leaf.double_sided = true;
  MaterialDescription coated = plastic(0.4f);
  coated.clearcoat = 1;
  coated.clearcoat_roughness = 0.2f;
  builder.add(parallelogram({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), diffuse(0.6f))
      .add(parallelogram({-3, 0, -3}, {6, 0, 0}, {0, 3, 0}), coated)
      .add(parallelogram({-0.6f, 2.4f, -0.6f}, {0, 0, -1}, {-1, 0, 0}), panel)
      .add(sphere({-0.9f, 0.5f, -1}, 0.5f, 12, 24), metal(0.3f))
      .add(sphere({0.4f, 0.5f, -1.6f}, 0.5f, 12, 24), glass(0.3f))
      .add(parallelogram({0.9f, 0.1f, -1}, {0.6f, 0, 0}, {0, 0.8f, 0}), leaf)
      .add(parallelogram({-0.2f, 0.1f, 0}, {0.6f, 0, 0}, {0, 0.8f, 0}), pane);
  if (lit.lamp) {
    PunctualLightDescription lamp;
    lamp.name = "lamp";
    lamp.intensity = 4;
    lamp.to_world.origin = {1.5f, 2, 0.5f};
    builder.add(lamp);
  }
  if (lit.sky) builder.environment([](const Vec3f& w) { return w.y > 0 ? 0.5f : 0.1f; });
  return builder.description();
}

CameraDescription view() {
  CameraDescription camera;
  camera.yfov = 0.9f;
  camera.to_world.origin = {0, 0.5f, 3};
  return camera;
}

LightSplit all_parts() {
  LightSplit split;
  for (const auto name : light_way_names()) split.ways.emplace_back(name);
  split.groups = {{"panel", {"panel"}}, {"lamp", {"lamp"}}, {"sky", {"environment"}}};
  return split;
}

/// Means over the view of each part and of the whole, of independent sets.
std::vector<Samples> measure_parts(const Scene& scene, const IntegratorOptions& options,
                                   const LightSplit& split, int samples) {
  constexpr int sets = 12, side = 12;
  const auto integrator = path(options);
  const LightSorter sorter(split, scene);
  const Camera camera(view(), side, side);
  const size_t count = sorter.layers().size();
  std::vector<std::vector<double>> sums(sets, std::vector<double>(count + 1, 0));
  parallel_for(sums.size(), [&](size_t set) {
    for (int i = 0; i < samples * side * side; ++i) {
      const int pixel = i % (side * side);
      Sampler sampler(uint32_t(pixel), uint32_t(i / (side * side)), 77 + set);
      const int row = pixel / side, column = pixel % side;
      const Ray ray = camera.ray(Vec2f(float(column), float(row)) + sampler.next2());
      LightParts parts;
      const Estimate estimate = integrator->estimate(scene, ray, sampler, {0, &sorter, &parts});
      for (size_t p = 0; p < count; ++p) sums[set][p] += double(sorter.part(parts, p).y);
      sums[set][count] += double(estimate.radiance.y);
    }
  });
  std::vector<Samples> means(count + 1);
  for (const auto& sum : sums)
    for (size_t p = 0; p <= count; ++p) means[p].add(sum[p] / (samples * side * side));
  return means;
}

RenderSettings settings(const LightSplit& split) {
  RenderSettings s;
  s.width = s.height = 24;
  s.camera = view();
  s.light_split = split;
  s.limits.spp = 24;
  return s;
}

std::shared_ptr<const Scene> shared_room(const Lit& lit = {}) {
  SceneDescription description = room(lit);
  description.hash = "room";
  return build_scene(std::move(description));
}

TEST(LightParts, OfEitherKindAddUpToThePicture) {
  for (const Background::Kind kind : {Background::Kind::surroundings, Background::Kind::color}) {
    RenderSettings s = settings(all_parts());
    s.background.kind = kind;
    s.background.color = {0.2f, 0.4f, 0.8f};
    RenderSession session(shared_room(), s);
    session.run();
    const LayeredImage picture = session.picture("light,light_groups");
    const Image whole = picture.rgb();
    Image ways(whole.width, whole.height, 3), groups = ways;
    const auto add = [&](Image& sum, const std::string& layer) {
      const Image part = *picture.layer(layer);
      for (size_t i = 0; i < part.values.size(); ++i) sum.values[i] += part.values[i];
    };
    for (const auto name : light_way_names()) add(ways, std::string(name));
    for (const char* name : {"light_panel", "light_lamp", "light_sky", "light_rest"}) add(groups, name);
    for (size_t i = 0; i < whole.values.size(); ++i) {
      EXPECT_NEAR(ways.values[i], whole.values[i], 1e-5f * whole.values[i]) << i;
      EXPECT_NEAR(groups.values[i], whole.values[i], 1e-5f * whole.values[i]) << i;
    }
  }
}

TEST(LightParts, ChangeNothingInThePicture) {
  RenderSession with(shared_room(), settings(all_parts())), without(shared_room(), settings({}));
  with.run();
  without.run();
  EXPECT_EQ(with.picture().image.values, without.picture().image.values);
}

// The three techniques meet a part of the light by different events, which must be told apart alike.
TEST(LightParts, OfEveryTechniqueAreTheSame) {
  const Scene scene(room({.lamp = false}), {});
  LightSplit split = all_parts();
  split.groups.erase(split.groups.begin() + 1);
  const int samples = 64 / thinning;
  std::vector<std::vector<Samples>> measured;
  for (const LightSampling technique : {LightSampling::mis, LightSampling::light, LightSampling::bsdf})
    measured.push_back(measure_parts(scene, {.max_depth = 6, .light_sampling = technique}, split, samples));
  for (size_t part = 0; part < measured[0].size(); ++part)
    for (const size_t other : {1, 2}) {
      const Samples &a = measured[0][part], &b = measured[other][part];
      if (a.variance() == 0 && b.variance() == 0) {
        EXPECT_EQ(a.mean(), b.mean()) << part;
        continue;
      }
      EXPECT_GT(welch_p_value(a, b), 1e-4) << part << ": " << a.mean() << " and " << b.mean();
    }
}

// Light is linear: a group's is that of a scene where no other light shines.
TEST(LightParts, OfAGroupAreTheSceneLitByItAlone) {
  const Scene all(room({}), {});
  const int samples = 64 / thinning;
  const LightSplit split{{}, all_parts().groups};
  const std::vector<Samples> groups = measure_parts(all, {.max_depth = 6}, split, samples);
  const Lit alone[] = {{true, false, false}, {false, true, false}, {false, false, true}};
  for (size_t group = 0; group < 3; ++group) {
    const Scene scene(room(alone[group]), {});
    const Samples lit = measure_parts(scene, {.max_depth = 6}, {}, samples).back();
    EXPECT_GT(welch_p_value(groups[group], lit), 1e-4)
        << group << ": " << groups[group].mean() << " and " << lit.mean();
    EXPECT_GT(lit.mean(), 0.001);
  }
  EXPECT_EQ(groups[3].mean(), 0) << "no light is left over";
}

/// The parts of what a camera ray sees of a surface under a lamp and a bright wall.
LightParts parts_of(const MaterialDescription& material, bool lamp_behind) {
  SceneBuilder builder;
  builder.add(parallelogram({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), material);
  PunctualLightDescription lamp;
  lamp.intensity = 10;
  lamp.to_world.origin = {0, 0.4f, lamp_behind ? -2.f : 2.f};
  builder.add(lamp);
  const Scene scene = builder.build();
  const LightSorter sorter({all_parts().ways, {}}, scene);
  LightParts sum;
  for (uint32_t i = 0; i < 256; ++i) {
    Sampler sampler(0, i, 1);
    path({.max_depth = 2})
        ->estimate(scene, ray_through({0, -0.4f, 2}, {0, 0, 0}), sampler, {0, &sorter, &sum});
  }
  return sum;
}

TEST(LightParts, AreNamedAfterWhatTheFirstSurfaceDoes) {
  const auto nonzero = [](const LightParts& parts) {
    std::vector<std::string> names;
    for (size_t way = 0; way < light_way_count; ++way)
      if (!is_black(parts.ways[way])) names.emplace_back(light_way_names()[way]);
    return names;
  };
  using Names = std::vector<std::string>;
  MaterialDescription leaf = diffuse(0.8f);
  leaf.diffuse_transmission = 1;
  leaf.double_sided = true;
  MaterialDescription frosted = glass(0.4f);
  frosted.thickness = 0;
  frosted.double_sided = true;
  EXPECT_EQ(nonzero(parts_of(diffuse(0.5f), false)), Names{"diffuse_direct"});
  EXPECT_EQ(nonzero(parts_of(metal(0.4f), false)), Names{"glossy_direct"});
  EXPECT_EQ(nonzero(parts_of(plastic(0.4f), false)), (Names{"diffuse_direct", "glossy_direct"}));
  EXPECT_EQ(nonzero(parts_of(leaf, true)), Names{"diffuse_direct"});
  EXPECT_EQ(nonzero(parts_of(frosted, true)), Names{"transmission_direct"});
  EXPECT_EQ(nonzero(parts_of(frosted, false)), Names{"glossy_direct"});
}

TEST(LightParts, GoOnFromACheckpointAndMerge) {
  const TemporaryFolder folder;
  RenderSettings s = settings(all_parts());
  RenderSession whole(shared_room(), s);
  whole.run();
  s.limits.spp = 10;
  RenderSession first(shared_room(), s);
  first.run();
  first.save(folder.file("a.ckpt"));
  RenderSession second(shared_room(), settings(all_parts()));
  second.load(folder.file("a.ckpt"));
  second.run();
  const std::string layers = "light,light_groups,error";
  EXPECT_EQ(second.picture(layers).channel_names, whole.picture(layers).channel_names);
  EXPECT_EQ(second.picture(layers).image.values, whole.picture(layers).image.values);

  RenderSession other(shared_room(), settings({}));
  EXPECT_THROW(other.load(folder.file("a.ckpt")), Error);
}

TEST(LightParts, HaveErrorsThatTellHowWrongTheyAre) {
  RenderSettings s = settings({{"diffuse_direct", "diffuse_indirect"}, {}});
  s.limits.spp = 64;
  const auto picture = [&](uint64_t seed) {
    s.seed = seed;
    RenderSession session(shared_room(), s);
    session.run();
    return session.picture("diffuse_direct,diffuse_indirect,error");
  };
  const LayeredImage a = picture(1), b = picture(2);
  for (const std::string name : {"diffuse_direct", "diffuse_indirect"}) {
    const Image value_a = *a.layer(name), value_b = *b.layer(name), error = *a.layer(name + "_error");
    double squares = 0, told = 0;
    for (size_t i = 0; i < value_a.values.size(); ++i) {
      squares += square(double(value_a.values[i]) - double(value_b.values[i]));
      told += 2 * square(double(error.values[i]));
    }
    EXPECT_NEAR(std::sqrt(squares / told), 1, 0.25) << name;
  }
}

TEST(LightParts, UnknownOnesAreRefusedWithTheNearest) {
  const auto problem = [](const LightSplit& split, const char* integrator = "path") {
    RenderSettings s = settings(split);
    s.integrator = integrator;
    try {
      RenderSession session(shared_room(), s);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(problem({{"difuse_direct"}, {}}), HasSubstr("'diffuse_direct'"));
  EXPECT_THAT(problem({{}, {{"key", {"lam"}}}}), HasSubstr("did you mean 'lamp'"));
  EXPECT_THAT(problem({{}, {{"key.1", {"lamp"}}}}), HasSubstr("letters, digits"));
  EXPECT_THAT(problem({{}, {{"rest", {"lamp"}}}}), HasSubstr("two groups"));
  EXPECT_THAT(problem({{}, std::vector<LightGroup>(16, {"a", {"lamp"}})}), HasSubstr("expected 15"));
  EXPECT_THAT(problem(all_parts(), "whitted"), HasSubstr("path does"));
  RenderSession session(shared_room(), settings({}));
  session.run();
  EXPECT_THROW(session.picture("diffuse_direct"), Error);
}

}  // namespace
}  // namespace vernier::test
