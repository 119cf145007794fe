// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "scene/accel/accelerator.h"
#include "scene/accel/brute_force.h"
#include "scene/accel/bvh.h"
#include "scene/accel/edge_list.h"
#include "scene/accel/embree.h"
#include "scene/accel/octree.h"

namespace vernier {

namespace {

using enum Watertight;

constexpr AcceleratorEntry embree{"embree", "Embree, robust mode: may leak at vertices; the default",
                                  at_edges, build_embree_robust};
constexpr AcceleratorEntry list{
    "list", "every triangle, with the answers of bvh: the default where there are only a few dozen",
    at_edges_and_vertices, build_edge_list};
constexpr std::array table{
    embree,
    AcceleratorEntry{
        "bvh", "our own, to check it: watertight at edges and vertices, the same answers on every machine",
        at_edges_and_vertices, build_bvh},
    list,
    AcceleratorEntry{"embree-fast", "Embree, fast mode: leaks at edges and vertices", nowhere,
                     build_embree_fast, true},
    AcceleratorEntry{"bvh-moeller", "our own with the Moeller-Trumbore test: leaks at edges and vertices",
                     nowhere, build_bvh_moeller, true},
    AcceleratorEntry{"octree", "triangles in every cell they touch, to compare with", at_edges_and_vertices,
                     build_octree, true},
    AcceleratorEntry{"brute_force", "every triangle for every ray, for tests", at_edges_and_vertices,
                     build_brute_force, true},
};

}  // namespace

std::span<const AcceleratorEntry> accelerators() { return table; }

const AcceleratorEntry& quickest_accelerator(const Geometry& geometry) {
  return suits_edge_list(geometry) ? list : embree;
}

}  // namespace vernier
