// SPDX-License-Identifier: Apache-2.0
#include "apps/validation/cases.h"

#include <algorithm>
#include <array>

#include "apps/validation/agreement.h"
#include "apps/validation/invariance.h"
#include "apps/validation/limits.h"
#include "apps/validation/spawning.h"
#include "apps/validation/structure.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/bvh.h"

namespace vernier::validation {
namespace {

using Entry = AcceleratorEntry;

constexpr Aim elsewhere[] = {{10, 1e-6f, {0, 0, 0}}, {10, 1e6f, {0, 0, 0}}, {10, 1, {500, -700, 300}}};
constexpr uint64_t some = 1'000'000, few = 100'000;

template <typename Measure>
Count over_places(uint64_t rays, const Measure& leaks) {
  Count sum;
  for (const Aim& aim : elsewhere) sum += leaks(aim, rays / std::size(elsewhere));
  return sum;
}

/// The scales and the distances from the origin at which spawned rays are looked at.
std::vector<SpawnCase> spawn_cases(bool instanced, bool copied = false) {
  std::vector<SpawnCase> cases;
  for (const float scale : {1e-6f, 1e-3f, 1.f, 1e3f, 1e6f}) cases.push_back({scale, 0, instanced, copied});
  for (const float offset : {1e3f, 1e5f, 1e7f}) cases.push_back({1, offset, instanced, copied});
  return cases;
}

Count all_self_hits(BuildAccelerator build, const std::vector<SpawnCase>& cases, uint64_t rays) {
  Count sum;
  for (const SpawnCase& c : cases) sum += self_hits(build, c, rays / cases.size(), 1);
  return sum;
}

double widest_lost_gap(BuildAccelerator build, uint64_t rays) {
  const auto cases = spawn_cases(false);
  unsigned widest = 0;
  for (const SpawnCase& c : cases) {
    const unsigned gap = smallest_gap(build, c, rays / cases.size(), 1);
    if (gap == 0) return std::numeric_limits<double>::infinity();
    widest = std::max(widest, gap);
  }
  return widest;
}

/// On triangles of all sizes, waves and a closed surface; against `bvh`, which itself is held against brute
/// force.
Disagreements disagreements(const Entry& entry, uint64_t rays) {
  constexpr uint64_t scenes = 8;
  const BuildAccelerator reference = entry.build == build_bvh ? build_brute_force : build_bvh;
  Disagreements sum;
  for (uint64_t seed = 1; seed <= scenes; ++seed) {
    Rng rng(seed, 0);
    TriangleSoup soup;
    add_random_triangles(soup, rng, 300, rng.magnitude(.03f, .5f));
    add_waves(soup, 12);
    add_blob(soup, rng, 2, .5f, rng.in_cube(.5f));
    const auto part =
        compare(*entry.build(soup.geometry()), *reference(soup.geometry()), soup, rays / scenes, seed);
    sum.rays += part.rays;
    sum.within_rounding += part.within_rounding;
    sum.real += part.real;
  }
  return sum;
}

double worst_barycentric(const HitErrors& errors) { return std::max(errors.u, errors.v); }

double stress_cost(const Entry& entry, std::string_view name) {
  const auto stress = std::ranges::find(stresses(), name, &Stress::name);
  return build_cost(entry.build, *stress);
}

constexpr std::array table{
    HardCase{"edge-1", "leaks at a shared edge per 10^6, from 1 size away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_edges(e.build, {1, 1, {0, 0, 0}}, n, 1));
             }},
    HardCase{"edge-100", "the same from 100 sizes away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_edges(e.build, {100, 1, {0, 0, 0}}, n, 2));
             }},
    HardCase{"edge-10000", "the same from 10^4 sizes away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_edges(e.build, {1e4f, 1, {0, 0, 0}}, n, 3));
             }},
    HardCase{"edge-elsewhere", "the same at sizes 10^-6 and 10^6, and 900 sizes from the origin",
             [](const Entry& e, uint64_t n) {
               return Figure(over_places(
                   n, [&](const Aim& aim, uint64_t rays) { return leaks_at_edges(e.build, aim, rays, 4); }));
             }},
    HardCase{"vertex-1", "leaks at a vertex of six triangles per 10^6, from 1 size away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_vertices(e.build, {1, 1, {0, 0, 0}}, n, 5));
             }},
    HardCase{"vertex-100", "the same from 100 sizes away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_vertices(e.build, {100, 1, {0, 0, 0}}, n, 6));
             }},
    HardCase{"vertex-10000", "the same from 10^4 sizes away",
             [](const Entry& e, uint64_t n) {
               return Figure(leaks_at_vertices(e.build, {1e4f, 1, {0, 0, 0}}, n, 7));
             }},
    HardCase{"vertex-elsewhere", "the same at sizes 10^-6 and 10^6, and 900 sizes from the origin",
             [](const Entry& e, uint64_t n) {
               return Figure(over_places(n, [&](const Aim& aim, uint64_t rays) {
                 return leaks_at_vertices(e.build, aim, rays, 8);
               }));
             }},
    HardCase{"closed-surface", "leaks out of a closed surface, aimed at its edges and vertices, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(leaks_of_closed_surface(e.build, n, 9)); }},
    HardCase{"parity", "rays aimed there that do not enter as often as they leave, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(parity_errors(e.build, n, 10)); }, some},
    HardCase{"disagreement", "answers no rounding excuses, against `bvh` (it: against brute force), per 10^6",
             [](const Entry& e, uint64_t n) {
               const Disagreements d = disagreements(e, n);
               return Figure(Count{d.real, d.rays});
             }},
    HardCase{"within-rounding", "other differences there, at boundaries and ties within rounding, per 10^6",
             [](const Entry& e, uint64_t n) {
               const Disagreements d = disagreements(e, n);
               return Figure(Count{d.within_rounding, d.rays});
             },
             some},
    HardCase{"needle-1", "wrong hits and misses on triangles 11.1 x 1, grazing, from 600 away, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(needle_errors(e.build, 1, n, 11).wrong); }, some},
    HardCase{"needle-0.01", "the same on triangles 11.1 x 0.01",
             [](const Entry& e, uint64_t n) { return Figure(needle_errors(e.build, .01f, n, 12).wrong); },
             some},
    HardCase{"t-error", "largest error of t, in units of the forward bound on float arithmetic",
             [](const Entry& e, uint64_t n) { return Figure(hit_errors(e.build, 1, 0, n, 13).t); }, some},
    HardCase{"uv-error", "largest error of u and v, in the same",
             [](const Entry& e, uint64_t n) {
               return Figure(worst_barycentric(hit_errors(e.build, 1, 0, n, 13)));
             },
             some},
    HardCase{"sliver-t-error", "of t, on triangles 10 times as long as high",
             [](const Entry& e, uint64_t n) { return Figure(hit_errors(e.build, .1f, 0, n, 14).t); }, some},
    HardCase{"sliver-uv-error", "of u and v, on those",
             [](const Entry& e, uint64_t n) {
               return Figure(worst_barycentric(hit_errors(e.build, .1f, 0, n, 14)));
             },
             some},
    HardCase{
        "self-hits", "spawned rays that hit what they leave, scales 10^-6 to 10^6, offsets to 10^7, per 10^6",
        [](const Entry& e, uint64_t n) { return Figure(all_self_hits(e.build, spawn_cases(false), n)); }},
    HardCase{"self-hits-instanced", "the same through rotated and stretched instances",
             [](const Entry& e, uint64_t n) { return Figure(all_self_hits(e.build, spawn_cases(true), n)); }},
    HardCase{"copy-hits", "spawned rays that hit a copy of what they leave, in the same place, per 10^6",
             [](const Entry& e, uint64_t n) {
               return Figure(all_self_hits(e.build, spawn_cases(false, true), n));
             }},
    HardCase{"gap", "narrowest gap that no spawned ray jumps, in ulps of the largest coordinate",
             [](const Entry& e, uint64_t n) { return Figure(widest_lost_gap(e.build, n)); }, some},
    HardCase{"phantoms", "hits by invalid rays, in a triangle's plane and on degenerate triangles, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(phantom_hits(e.build, n, 15)); }, some},
    HardCase{"interval", "answers that break the open interval (t_min, t_max), per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(interval_errors(e.build, n, 16)); }, some},
    HardCase{"invalid-cost", "time of an invalid ray over that of a valid one",
             [](const Entry& e, uint64_t n) { return Figure(invalid_ray_cost(e.build, n, 17)); }, few / 10},
    HardCase{"smallest-size", "power of ten down to which triangles are hit",
             [](const Entry& e, uint64_t) { return Figure(sizes_hit(e.build, false).smallest); }, 1},
    HardCase{"smallest-flushed", "the same in threads that flush denormals",
             [](const Entry& e, uint64_t) { return Figure(sizes_hit(e.build, true).smallest); }, 1},
    HardCase{"largest-size", "power of ten up to which triangles are hit (the more the better)",
             [](const Entry& e, uint64_t) { return Figure(sizes_hit(e.build, false).largest); }, 1},
    HardCase{"scaling", "answers changed by scaling everything by 2^k, k from -24 to 24, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(changed_by_scaling(e.build, n, 18)); }, some},
    HardCase{"signed-zeros", "answers changed by the sign of zeros in directions, per 10^6",
             [](const Entry& e, uint64_t) { return Figure(changed_by_signed_zeros(e.build)); }, 1},
    HardCase{"rebuild", "coinciding triangles: another wins after a rebuild, per 10^6",
             [](const Entry& e, uint64_t n) { return Figure(changed_by_rebuild(e.build, n, 19)); }, some},
    HardCase{"instance", "error of t in a rotated instance, in ulps times the transform's distortion",
             [](const Entry& e, uint64_t n) {
               return Figure(instance_error(e.build, {1, 1, 1}, {0, 0, 0}, n, 20));
             },
             few},
    HardCase{"instance-stretched", "the same scaled by (1, 10, -1/10)",
             [](const Entry& e, uint64_t n) {
               return Figure(instance_error(e.build, {1, 10, -.1f}, {0, 0, 0}, n, 21));
             },
             few},
    HardCase{"instance-far", "the same of size 10^4 at 10^6 from the origin",
             [](const Entry& e, uint64_t n) {
               return Figure(instance_error(e.build, {1e4f, 1e4f, -1e4f}, {1e6f, -1e6f, 1e6f}, n, 22));
             },
             few},
    HardCase{"build-same-centroid", "build time of 10^5 triangles with one centroid, over a plain mesh's",
             [](const Entry& e, uint64_t) { return Figure(stress_cost(e, "SameCentroid")); }, 1},
    HardCase{"build-copies", "of 10^5 copies of one triangle",
             [](const Entry& e, uint64_t) { return Figure(stress_cost(e, "CopiesOfOneTriangle")); }, 1},
    HardCase{"build-diagonals", "of 10^5 needles from one side to the opposite corner",
             [](const Entry& e, uint64_t) { return Figure(stress_cost(e, "LongDiagonals")); }, 1},
    HardCase{"ten-million", "wrong triangles in a mesh of 10^7, per 10^6",
             [](const Entry& e, uint64_t n) {
               return Figure(
                   wrong_in_large_mesh(e.build, 10'000'000, e.build == build_brute_force ? n / 1000 : n, 23));
             },
             some},
};

}  // namespace

std::span<const HardCase> hard_cases() { return table; }

}  // namespace vernier::validation
