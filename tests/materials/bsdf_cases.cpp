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

void add_conductors(CaseList& list) {
  for (const float r : roughnesses) {
    list.add(fmt::format("white conductor, roughness {}", r), Conductor{white, white, ggx(r)}, ggx(r))
        .lossless = true;
    list.add(fmt::format("gold, roughness {}", r), Conductor{gold, white, ggx(r)}, ggx(r));
  }
  for (const Ggx& widths : {Ggx{0.3f, 0.05f}, Ggx{0.0025f, 0.09f}, Ggx{1, 0.3f}})
    list.add(fmt::format("white conductor, widths {} {}", widths.ax, widths.ay),
             Conductor{white, white, widths}, widths)
        .excess = 0.08;
}

void add_plastics(CaseList& list) {
  const Rgb f0(0.04f, 0.04f, 0.04f);
  for (const float r : roughnesses) {
    list.add(fmt::format("white plastic, roughness {}", r), Plastic{white, f0, white, ggx(r)}, ggx(r))
        .lossless = true;
    list.add(fmt::format("blue plastic, roughness {}", r), Plastic{blue, f0, white, ggx(r)}, ggx(r));
  }
  list.add("plastic of infinite index", Plastic{white, white, white, ggx(0.3f)}, ggx(0.3f)).lossless = true;
  list.add("plastic of half specular", Plastic{white, f0 * 0.5f, white * 0.5f, ggx(0.3f)}, ggx(0.3f))
      .lossless = true;
}

Dielectric thick(float eta, const Ggx& widths, const Rgb& tint, const Rgb& reflect_scale) {
  return {eta, widths, tint, reflect_scale, false, widths.is_smooth() ? nullptr : &GlassEnergy::of(eta)};
}

BsdfCase& add_dielectric(CaseList& list, const std::string& name, float eta, const Ggx& widths,
                         const Rgb& tint, const Rgb& reflect_scale) {
  BsdfCase& added = list.add(name, thick(eta, widths, tint, reflect_scale),
                             thick(1 / eta, widths, tint, reflect_scale), widths);
  added.eta = eta;
  added.transmits = true;
  added.lossless = tint == white;
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
    const Dielectric thin{1.5f, ggx(r), white, white, true};
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
                   {9, 3, 1})
        .lossless = false;
    add_dielectric(list, fmt::format("glass of coloured specular, index {:.3f}", eta), eta, ggx(1), white,
                   blue)
        .tolerance = 2e-3;
  }
}

void add_mixtures(CaseList& list) {
  for (const float r : {0.f, 0.05f, 0.3f, 1.f})
    for (const float eta : {1.5f, 1 / 1.5f})
      for (const bool thin : {false, true}) {
        if (thin && eta < 1) continue;
        const Rgb f0(0.04f, 0.04f, 0.04f);
        const auto make = [&](float index) {
          const Dielectric glass =
              thin ? Dielectric{index, ggx(r), white, white, true} : thick(index, ggx(r), white, white);
          return Mixture{
              Conductor{white, white, ggx(r)}, Plastic{white, f0, white, ggx(r)}, glass, 0.4f, 0.35f, 0.25f};
        };
        BsdfCase& added =
            list.add(fmt::format("{}mixture, index {:.3f}, roughness {}", thin ? "thin " : "", eta, r),
                     make(eta), make(1 / eta), ggx(r));
        added.eta = thin ? 1 : eta;
        added.transmits = added.lossless = true;
        added.reciprocal = ggx(r).is_smooth();
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
