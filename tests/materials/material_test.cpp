// SPDX-License-Identifier: Apache-2.0
#include "materials/material.h"

#include <gtest/gtest.h>

#include <functional>

// What becomes of glTF's material parameters.

namespace vernier::test {
namespace {

using Describe = std::function<void(MaterialDescription&)>;

MaterialDescription described(const Describe& describe) {
  MaterialDescription description;
  description.base_color = {0.8f, 0.4f, 0.2f, 1};
  description.metallic = 0;
  description.roughness = 0.5f;
  describe(description);
  return description;
}

Bsdf bsdf(const MaterialDescription& description, const BsdfContext& context = {},
          std::span<const Texture> textures = {}) {
  return Material(description, textures, false).bsdf({}, context);
}

template <typename Model>
bool is(const Describe& describe, const BsdfContext& context = {}) {
  return std::holds_alternative<Model>(static_cast<const Bsdf::variant&>(bsdf(described(describe), context)));
}

Vec3f direction(float cosine, float azimuth) {
  const float sine = safe_sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

void expect_same(const Bsdf& actual, const Bsdf& expected) {
  for (const float cos_o : {0.95f, 0.4f})
    for (const float cos_i : {0.9f, 0.3f, -0.6f}) {
      const Vec3f wo = direction(cos_o, 0.3f), wi = direction(cos_i, 2.9f);
      const BsdfEval a = actual.eval(wo, wi), b = expected.eval(wo, wi);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.f_cos[c], b.f_cos[c], 1e-5f + 1e-4f * b.f_cos[c]);
      EXPECT_NEAR(a.pdf, b.pdf, 1e-5f + 1e-4f * b.pdf);
    }
}

TEST(Material, IsTheLeastModel) {
  EXPECT_TRUE(is<Glossy>([](auto&) {}));
  EXPECT_TRUE(is<Lambert>([](auto& m) { m.specular = 0; }));
  EXPECT_TRUE(is<Lambert>([](auto& m) { m.unlit = true; }));
  EXPECT_TRUE(is<RoughDiffuse>([](auto& m) { m.specular = 0, m.diffuse_roughness = 0.1f; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.diffuse_roughness = 0.1f; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.metallic = 1; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.metallic = 0.5f; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.metallic = 1, m.transmission = 1; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.specular = 0, m.diffuse_transmission = 0.5f; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.specular = 0, m.iridescence = 1; }));
  EXPECT_TRUE(
      is<Lambert>([](auto& m) { m.specular = 0, m.iridescence = 1, m.iridescence_thickness_max = 0; }));
  EXPECT_TRUE(is<Dielectric>([](auto& m) { m.transmission = 1; }));
  EXPECT_TRUE(is<Mixture>([](auto& m) { m.transmission = 0.5f; }));
  EXPECT_TRUE(is<Glossy>([](auto& m) { m.clearcoat_roughness = 0.5f, m.sheen_roughness = 1; }));
  EXPECT_TRUE(is<Layered>([](auto& m) { m.clearcoat = 0.1f; }));
  EXPECT_TRUE(is<Layered>([](auto& m) { m.sheen_color = {0, 0, 0.1f}; }));
}

TEST(Material, LayersLieOutsideOfVolumes) {
  const auto coated_glass = [](auto& m) { m.transmission = m.thickness = m.clearcoat = 1; };
  EXPECT_TRUE(is<Layered>(coated_glass, {true}));
  EXPECT_TRUE(is<Dielectric>(coated_glass, {false}));
  EXPECT_TRUE(is<Layered>([](auto& m) { m.transmission = m.clearcoat = 1; }, {false}));
}

TEST(Material, DiffuseTransmissionAloneBoundsAVolume) {
  const Material wax(described([](auto& m) {
                       m.diffuse_transmission = 1;
                       m.thickness = 1;
                       m.attenuation_color = {0.5f, 1, 1};
                       m.attenuation_distance = 2;
                     }),
                     {}, false);
  EXPECT_TRUE(wax.transmits() && wax.is_volume_boundary());
  EXPECT_NEAR(wax.extinction().x, std::log(2.f) / 2, 1e-6f);
  // Pure diffuse transmission bends nothing, so radiance is not compressed either.
  const auto through = wax.bsdf({}, {}).sample({0, 0, 1}, 0.999f, {0.4f, 0.7f});
  ASSERT_TRUE(through && through->is_transmitted());
  EXPECT_EQ(through->eta, 1);
}

/// A texture of one texel 51, 102, 153, 204: 0.2, 0.4, 0.6, 0.8 unless decoded.
Texture one_texel() {
  auto image = std::make_shared<Image8>(1, 1, 4);
  image->values = {51, 102, 153, 204};
  return {image, WrapMode::repeat, WrapMode::repeat, FilterMode::nearest};
}

struct Slot {
  const char* name;
  TextureUse MaterialDescription::*texture;
  Describe base;    ///< what shows the slot
  Describe factor;  ///< what the texel is to amount to
};

// Each slot reads the channels that its specification names: as if its factor had been multiplied by them.
TEST(Material, TexturesMultiplyFactors) {
  using M = MaterialDescription;
  const Texture texture = one_texel();
  const Vec4f decoded = texture.sample({0, 0}, TexelEncoding::srgb);
  const Rgb color(decoded.x, decoded.y, decoded.z);
  const Slot slots[] = {
      {"base colour", &M::base_color_texture, [](M&) {},
       [&](M& m) { m.base_color *= Vec4f(color.x, color.y, color.z, 1); }},
      {"metallic roughness", &M::metallic_roughness_texture, [](M& m) { m.metallic = m.roughness = 1; },
       [](M& m) { m.roughness = 0.4f, m.metallic = 0.6f; }},
      {"diffuse roughness", &M::diffuse_roughness_texture, [](M& m) { m.diffuse_roughness = 1; },
       [](M& m) { m.diffuse_roughness = 0.2f; }},
      {"specular", &M::specular_texture, [](M&) {}, [](M& m) { m.specular = 0.8f; }},
      {"specular colour", &M::specular_color_texture, [](M&) {}, [&](M& m) { m.specular_color = color; }},
      {"transmission", &M::transmission_texture, [](M& m) { m.transmission = 1; },
       [](M& m) { m.transmission = 0.2f; }},
      {"clearcoat", &M::clearcoat_texture, [](M& m) { m.clearcoat = 1, m.clearcoat_roughness = 0.5f; },
       [](M& m) { m.clearcoat = 0.2f; }},
      {"clearcoat roughness", &M::clearcoat_roughness_texture,
       [](M& m) { m.clearcoat = m.clearcoat_roughness = 1; }, [](M& m) { m.clearcoat_roughness = 0.4f; }},
      {"sheen colour", &M::sheen_color_texture,
       [](M& m) {
         m.sheen_color = {1, 1, 1}, m.sheen_roughness = 0.5f;
       },
       [&](M& m) { m.sheen_color = color; }},
      {"sheen roughness", &M::sheen_roughness_texture,
       [](M& m) {
         m.sheen_color = {1, 1, 1}, m.sheen_roughness = 1;
       },
       [](M& m) { m.sheen_roughness = 0.8f; }},
      {"anisotropy", &M::anisotropy_texture, [](M& m) { m.anisotropy = 1; },
       [](M& m) { m.anisotropy = 0.6f; }},
      {"iridescence", &M::iridescence_texture, [](M& m) { m.iridescence = 1; },
       [](M& m) { m.iridescence = 0.2f; }},
      {"iridescence thickness", &M::iridescence_thickness_texture, [](M& m) { m.iridescence = 1; },
       [](M& m) { m.iridescence_thickness_max = 220; }},
      {"diffuse transmission", &M::diffuse_transmission_texture, [](M& m) { m.diffuse_transmission = 1; },
       [](M& m) { m.diffuse_transmission = 0.8f; }},
      {"diffuse transmission colour", &M::diffuse_transmission_color_texture,
       [](M& m) { m.diffuse_transmission = 0.5f; }, [&](M& m) { m.diffuse_transmission_color = color; }},
  };
  for (const Slot& slot : slots) {
    SCOPED_TRACE(slot.name);
    MaterialDescription textured = described(slot.base), factored = textured;
    (textured.*slot.texture).texture = 0;
    slot.factor(factored);
    expect_same(bsdf(textured, {}, {&texture, 1}), bsdf(factored));
  }
}

TEST(Material, CoatDarkensEmission) {
  const Material coated(described([](auto& m) { m.emissive = {2, 2, 2}, m.clearcoat = 0.5f; }), {}, false);
  EXPECT_NEAR(coated.emission({}, true, 1).x, 2 * (1 - 0.5 * 0.04), 1e-6);
  EXPECT_NEAR(coated.emission({}, true, 0.5f).x, 2 * (1 - 0.5 * (0.04 + 0.96 / 32)), 1e-6);
  EXPECT_TRUE(is_black(coated.emission({}, false, 1)));
}

TEST(Material, AnisotropyDirectionTurnsWithRotationAndTexture) {
  const auto turned = [](auto& m) { m.anisotropy = 1, m.anisotropy_rotation = pi / 6; };
  const Vec2f plain = Material(described(turned), {}, false).anisotropy_direction({});
  EXPECT_NEAR(plain.x, std::sqrt(0.75f), 1e-6f);
  EXPECT_NEAR(plain.y, 0.5f, 1e-6f);
  const Texture texture = one_texel();  // red and green: (-0.6, -0.2)
  MaterialDescription description = described(turned);
  description.anisotropy_texture.texture = 0;
  const Vec2f mapped = Material(description, {&texture, 1}, false).anisotropy_direction({});
  const float angle = std::atan2(-0.2f, -0.6f) + pi / 6;
  EXPECT_NEAR(mapped.x, std::cos(angle), 1e-5f);
  EXPECT_NEAR(mapped.y, std::sin(angle), 1e-5f);
}

// alpha along the tangent is mix(alpha, 1, strength^2): highlights are stretched along x.
TEST(Material, AnisotropyStretchesAlongTheTangent) {
  const Bsdf brushed =
      bsdf(described([](auto& m) { m.metallic = 1, m.roughness = 0.3f, m.anisotropy = 0.5f; }));
  const Bsdf expected = Glossy::conductor({{0.8f, 0.4f, 0.2f}, 1, {}}, {lerp(0.25f, 0.09f, 1.f), 0.09f});
  expect_same(brushed, expected);
  const Vec3f up(0, 0, 1);
  EXPECT_GT(brushed.eval(up, direction(0.7f, 0)).f_cos.x,
            3 * brushed.eval(up, direction(0.7f, pi / 2)).f_cos.x);
}

// Half the spread between red and blue is (n - 1) / 2 / Abbe number on each side.
TEST(Material, DispersionSpreadsIndices) {
  const auto diamond = described([](auto& m) {
    m.transmission = m.thickness = 1;
    m.roughness = 0;
    m.ior = 2.4f;
    m.dispersion = 20 / 55.f;
  });
  const Material material(diamond, {}, false);  // the other colours' glass is kept there
  const Vec3f wo = direction(0.6f, 0);
  for (const bool front : {true, false})
    for (int c = 0; c < 3; ++c) {
      const Bsdf glass = material.bsdf({}, {.front = front, .channel = c});
      const auto sample = glass.sample(front ? wo : direction(0.97f, 0), 0.999f, {0, 0});
      ASSERT_TRUE(sample && sample->is_transmitted());
      const float ior = 2.4f + float(c - 1) * 1.4f / 55 / 2;
      EXPECT_NEAR(sample->eta, front ? ior : 1 / ior, 1e-5f);
      EXPECT_GT(sample->weight[(c + 1) % 3], 0);  // a path of one colour is not split again
    }
  EXPECT_TRUE(is_black(material.bsdf({}, {}).sample(wo, 0.3f, {0, 0})->weight * Rgb(0, 1, 1)));
}

}  // namespace
}  // namespace vernier::test
