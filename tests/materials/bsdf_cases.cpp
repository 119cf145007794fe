// SPDX-License-Identifier: Apache-2.0
#include "tests/materials/bsdf_cases.h"

#include <fmt/format.h>

namespace vernier::test {
namespace {

const Rgb white(1, 1, 1);
const Rgb gold(0.95f, 0.77f, 0.34f);
const Rgb blue(0.1f, 0.2f, 0.8f);
constexpr float roughnesses[] = {0, 0.001f, 0.05f, 0.3f, 1};

Ggx ggx(float roughness) { return {roughness * roughness, roughness * roughness}; }

class CaseList {
 public:
  BsdfCase& add(std::string name, const Bsdf& bsdf, const Bsdf& reverse, const Ggx& width) {
    const double narrowest = width.is_smooth() ? 1 : std::min(width.ax, width.ay);
    cases.push_back({std::move(name), bsdf, reverse, narrowest});
    return cases.back();
  }
  BsdfCase& add(std::string name, const Bsdf& bsdf, const Ggx& width) {
    return add(std::move(name), bsdf, bsdf, width);
  }

  std::vector<BsdfCase> cases;
};

Glossy conductor(const Rgb& f0, const Ggx& widths) { return Glossy::conductor({f0, 1, {}}, widths); }

Glossy plastic(const Rgb& diffuse, const Rgb& f0, float f90, const Ggx& widths) {
  return Glossy::coated_diffuse({f0, f90, {}}, widths, {diffuse});
}

void add_conductors(CaseList& list) {
  for (const float r : roughnesses) {
    list.add(fmt::format("white conductor, roughness {}", r), conductor(white, ggx(r)), ggx(r)).lossless =
        true;
    list.add(fmt::format("gold, roughness {}", r), conductor(gold, ggx(r)), ggx(r));
  }
  for (const Ggx& widths : {Ggx{0.3f, 0.05f}, Ggx{0.0025f, 0.09f}, Ggx{1, 0.3f}}) {
    list.add(fmt::format("white conductor, widths {} {}", widths.ax, widths.ay), conductor(white, widths),
             widths)
        .lossless = true;
    list.cases.back().tolerance = 5e-3;
  }
}

void add_plastics(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  for (const float r : roughnesses) {
    list.add(fmt::format("white plastic, roughness {}", r), plastic(white, f0, 1, ggx(r)), ggx(r)).lossless =
        true;
    list.add(fmt::format("blue plastic, roughness {}", r), plastic(blue, f0, 1, ggx(r)), ggx(r));
  }
  list.add("plastic of infinite index", plastic(white, white, 1, ggx(0.3f)), ggx(0.3f)).lossless = true;
  list.add("plastic of half specular", plastic(white, f0 * 0.5f, 0.5f, ggx(0.3f)), ggx(0.3f)).lossless = true;
}

/// Reflectance of an index, coloured at normal incidence as KHR_materials_specular does.
Fresnel fresnel(float eta, const Rgb& color = white) {
  Fresnel result;
  for (int c = 0; c < 3; ++c) result.f0[c] = std::min(f0_from_ior(eta) * color[c], 1.f);
  return result;
}

Dielectric thick(float eta, const Ggx& widths, const Rgb& tint, const Rgb& specular) {
  return {eta, widths, tint, fresnel(eta, specular), false, &DielectricAlbedo::of(eta)};
}

BsdfCase& add_dielectric(CaseList& list, const std::string& name, float eta, const Ggx& widths,
                         const Rgb& tint, const Rgb& specular) {
  BsdfCase& added =
      list.add(name, thick(eta, widths, tint, specular), thick(1 / eta, widths, tint, specular), widths);
  added.eta = eta;
  added.transmits = true;
  added.lossless = tint == white && specular == white;
  if (std::abs(eta - 1) < 0.02f) added.tolerance = 3e-3;
  added.excess = 1e-3;  // total internal reflection loses nothing, whatever the tint
  added.reciprocal = widths.is_smooth();
  return added;
}

void add_dielectrics(CaseList& list) {
  for (const float r : roughnesses) {
    for (const float eta : {1.5f, 1 / 1.5f})
      add_dielectric(list, fmt::format("glass, index {:.3f}, roughness {}", eta, r), eta, ggx(r), white,
                     white);
    const Dielectric thin{1.5f, ggx(r), white, fresnel(1.5f), true};
    BsdfCase& added = list.add(fmt::format("thin glass, roughness {}", r), thin, ggx(r));
    added.transmits = added.lossless = true;
    added.reciprocal = ggx(r).is_smooth();
  }
  for (const float eta : {1.01f, 1 / 1.01f, 2.4f, 1 / 2.4f, 1e6f})
    add_dielectric(list, fmt::format("glass, index {:.3g}, roughness 0.3", eta), eta, ggx(0.3f), white,
                   white);
  add_dielectric(list, "index-matched boundary", 1, ggx(0.3f), white, white).width = 1;
  for (const float eta : {1.5f, 1 / 1.5f}) {
    add_dielectric(list, fmt::format("blue glass, index {:.3f}", eta), eta, ggx(0.3f), blue, white);
    add_dielectric(list, fmt::format("glass of bright specular, index {:.3f}", eta), eta, ggx(0.3f), white,
                   {9, 3, 1});
    add_dielectric(list, fmt::format("glass of coloured specular, index {:.3f}", eta), eta, ggx(1), white,
                   blue);
  }
}

void add_mixtures(CaseList& list) {
  for (const float r : {0.f, 0.05f, 0.3f, 1.f})
    for (const float eta : {1.5f, 1 / 1.5f})
      for (const bool thin : {false, true}) {
        if (thin && eta < 1) continue;
        const Rgb f0(0.04f, 0.04f, 0.04f);
        const auto make = [&](float index) {
          const Dielectric glass = thin ? Dielectric{index, ggx(r), white, fresnel(index), true}
                                        : thick(index, ggx(r), white, white);
          const Glossy glossy = Glossy::mix(plastic(white, f0, 1, ggx(r)), conductor(white, ggx(r)), 0.5f);
          return Mixture{glossy, 0.25f, glass};
        };
        BsdfCase& added =
            list.add(fmt::format("{}mixture, index {:.3f}, roughness {}", thin ? "thin " : "", eta, r),
                     make(eta), make(1 / eta), ggx(r));
        added.eta = thin ? 1 : eta;
        added.transmits = added.lossless = true;
        added.reciprocal = ggx(r).is_smooth();
      }
}

void add_bodies(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  for (const float r : {0.f, 0.3f}) {
    BsdfCase& thin =
        list.add(fmt::format("leaf, roughness {}", r),
                 Glossy::coated_diffuse({f0, 1, {}}, ggx(r), {white * 0.3f, white * 0.7f, 1}), ggx(r));
    thin.transmits = thin.lossless = true;
  }
  list.add("plastic of coloured specular",
           Glossy::coated_diffuse({blue, 1, {}}, ggx(0.3f), {white, gold * 0.f, 1}), ggx(0.3f));
  // Diffuse transmission beside clear glass: light is n^2 times as dense inside.
  const auto make = [&](float eta) {
    return Mixture{Glossy::coated_diffuse({f0, 1, {}}, ggx(0.3f), {white * 0.5f, white * 0.5f, eta}), 0.4f,
                   thick(eta, ggx(0.3f), white, white)};
  };
  for (const float eta : {1.5f, 1 / 1.5f}) {
    BsdfCase& wax = list.add(fmt::format("wax, index {:.3f}", eta), make(eta), make(1 / eta), ggx(0.3f));
    wax.eta = eta;
    wax.transmits = wax.lossless = true;
    wax.reciprocal = false;
  }
}

/// Matte, under a clear layer, in part metal, and passed by light.
void add_rough_bodies(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  for (const float r : {1e-6f, 0.2f, 1.f}) {
    list.add(fmt::format("white, rough by {}", r), RoughDiffuse{white, Eon(r)}, ggx(1)).lossless = true;
    list.add(fmt::format("gold, rough by {}", r), RoughDiffuse{gold, Eon(r)}, ggx(1));
    const auto under = [&](const Ggx& widths, const Rgb& reflected, const Rgb& transmitted) {
      return Glossy::coated_diffuse({f0, 1, {}}, widths, {reflected, transmitted, 1, r});
    };
    for (const float layer : {0.f, 0.3f})
      list.add(fmt::format("plastic of roughness {} on white, rough by {}", layer, r),
               under(ggx(layer), white, {0, 0, 0}), ggx(layer));
    list.add(fmt::format("half metal, rough by {}", r),
             Glossy::mix(under(ggx(0.3f), blue, {0, 0, 0}), conductor(blue, ggx(0.3f)), 0.5f), ggx(0.3f));
    list.add(fmt::format("leaf, rough by {}", r), under(ggx(0.3f), white * 0.3f, white * 0.7f), ggx(0.3f))
        .transmits = true;
  }
}

void add_films(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  const ThinFilm thin{1, 1.3f, 400}, dense{0.7f, 2.5f, 120};
  list.add("gold under film", Glossy::conductor({gold, 1, thin}, ggx(0.3f)), ggx(0.3f));
  for (const float r : {0.f, 0.3f, 1.f})
    list.add(fmt::format("white plastic under film, roughness {}", r),
             Glossy::coated_diffuse({f0, 1, thin}, ggx(r), {white}), ggx(r));
  list.add("white plastic under dense film", Glossy::coated_diffuse({f0, 1, dense}, ggx(0.3f), {white}),
           ggx(0.3f));
  for (const float r : {0.f, 0.3f})
    for (const float eta : {1.5f, 1 / 1.5f}) {
      const auto make = [&](float index) {
        return Dielectric{index, ggx(r), white, {f0, 1, thin}, false, &DielectricAlbedo::of(index)};
      };
      BsdfCase& glass = list.add(fmt::format("glass under film, index {:.3f}, roughness {}", eta, r),
                                 make(eta), make(1 / eta), ggx(r));
      glass.eta = eta;
      glass.transmits = true;
      glass.excess = 5e-3;  // compensated as if there were no film
      glass.reciprocal = r == 0;
    }
}

void add_dispersion(CaseList& list) {
  static const auto dispersion_of = [](bool inverse) {
    Dispersion result{{1.4f, 1.5f, 1.6f}, {}};
    for (size_t c = 0; c < 3; ++c) {
      if (inverse) result.eta[c] = 1 / result.eta[c];
      result.energy[c] = &DielectricAlbedo::of(result.eta[c]);
    }
    return result;
  };
  static const Dispersion outside = dispersion_of(false), inside = dispersion_of(true);
  for (const float r : {0.f, 0.3f})
    for (const Dispersion* side : {&outside, &inside}) {
      if (r > 0 && side == &inside) continue;
      const auto make = [&](const Dispersion* of) {
        return Dielectric{of->eta[1], ggx(r), white, fresnel(1.5f), false, of->energy[1], of};
      };
      BsdfCase& added = list.add(
          fmt::format("dispersing glass from {}, roughness {}", side == &outside ? "outside" : "inside", r),
          make(side), make(side == &outside ? &inside : &outside), ggx(r));
      added.eta = side->eta[0];
      added.spread = 0.3;
      added.transmits = added.lossless = true;
      added.tolerance = 2e-3;
      added.reciprocal = r == 0;
    }
}

/// One color's index is that of the other side, so it is not bent, and rough facets do not show, while the
/// others are scattered. Energy is measured of the first color: once that one, once another.
void add_partly_matched_dispersion(CaseList& list) {
  static const auto dispersion_of = [](const std::array<float, 3>& eta) {
    Dispersion result{eta, {}};
    for (size_t c = 0; c < 3; ++c) result.energy[c] = &DielectricAlbedo::of(eta[c]);
    return result;
  };
  static const std::array<Dispersion, 2> sides{dispersion_of({1, 1.02f, 1.04f}),
                                               dispersion_of({1.02f, 1, 1.04f})};
  for (const float r : {0.f, 0.3f})
    for (const Dispersion& side : sides) {
      BsdfCase& added = list.add(
          fmt::format("dispersing glass, indices {} {} {}, roughness {}", side.eta[0], side.eta[1],
                      side.eta[2], r),
          Dielectric{side.eta[1], ggx(r), white, fresnel(1.5f), false, side.energy[1], &side}, ggx(r));
      added.eta = side.eta[0] == 1 ? 1.03 : side.eta[0];  // what is not bent is known to sample() alone
      added.spread = 0.05;
      added.transmits = added.lossless = true;
      added.tolerance = 5e-3;
      added.reciprocal = false;
    }
}

void add_layers(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  const auto base = [&](float r, const Rgb& color) { return Mixture{plastic(color, f0, 1, ggx(r)), 0, {}}; };
  for (const float coat : {0.f, 0.3f}) {
    BsdfCase& varnished = list.add(fmt::format("coat of roughness {} on white plastic", coat),
                                   Layered(base(0.3f, white), {}, {1, coat * coat}), ggx(0.3f));
    varnished.lossless = true;
    varnished.reciprocal = false;
  }
  const Mixture metal{conductor(gold, ggx(0.3f)), 0, {}};
  list.add("tilted coat on gold", Layered(metal, {}, {0.6f, 0.09f, normalize(Vec3f(0.3f, -0.4f, 1))}),
           ggx(0.3f))
      .reciprocal = false;
  for (const float r : {0.05f, 0.5f})
    list.add(fmt::format("white sheen of roughness {} on white plastic", r),
             Layered(base(0.3f, white), {white, r}, {}), ggx(0.3f));
  const Dielectric thin{1.5f, ggx(0.3f), white, fresnel(1.5f), true};
  BsdfCase& window =
      list.add("coat and sheen on thin glass",
               Layered({plastic(white, f0, 1, ggx(0.3f)), 0.6f, thin}, {gold, 0.5f}, {1, 0.01f}), ggx(0.1f));
  window.transmits = true;
  window.reciprocal = false;
  const Dielectric clear{1.5f, ggx(0), white, fresnel(1.5f), true};
  BsdfCase& pane =
      list.add("coat and sheen on clear thin glass",
               Layered({plastic(white, f0, 1, ggx(0.3f)), 0.6f, clear}, {gold, 0.5f}, {1, 0.01f}), ggx(0.1f));
  pane.transmits = true;
  pane.reciprocal = false;
}

void add_media(CaseList& list) {
  for (const float g : {0.f, 0.0005f, 0.3f, 0.8f, -0.6f}) {
    BsdfCase& medium = list.add(fmt::format("medium of mean cosine {}", g), HenyeyGreenstein{g}, ggx(1));
    medium.width = 1 - double(std::abs(g));
    medium.transmits = medium.lossless = true;
    medium.reciprocal = false;  // of a density without a cosine
  }
}

}  // namespace

std::vector<BsdfCase> bsdf_cases() {
  CaseList list;
  list.add("white Lambert", Lambert{white}, ggx(1)).lossless = true;
  list.add("gold Lambert", Lambert{gold}, ggx(1));
  add_conductors(list);
  add_plastics(list);
  add_dielectrics(list);
  add_mixtures(list);
  add_bodies(list);
  add_rough_bodies(list);
  add_films(list);
  add_dispersion(list);
  add_partly_matched_dispersion(list);
  add_layers(list);
  add_media(list);
  return list.cases;
}

Vec3f direction(float cosine, float azimuth) {
  const float sine = safe_sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

std::vector<Vec3f> outgoing_directions() {
  return {direction(1, 0), direction(0.8f, 0.4f), direction(0.5f, 1.3f), direction(0.1f, 2.6f),
          direction(0.01f, -1.9f)};
}

std::vector<HemisphereChart> charts(const BsdfCase& bsdf_case, const Vec3f& wo) {
  const double width = 0.3 * bsdf_case.width;
  std::vector<HemisphereChart> result{HemisphereChart::reflection(wo, width)};
  if (!bsdf_case.transmits) return result;
  result.push_back(bsdf_case.eta == 1 ? HemisphereChart::mirrored(wo, width)
                                      : HemisphereChart::refraction(wo, bsdf_case.eta, width));
  return result;
}

}  // namespace vernier::test
