// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/scene/import_support.h"

// Small valid files whose damaged copies try the importer.

namespace vernier::test {

/// Indexed, textured, skinned, morphed, animated, instanced, hidden, in variants; sparse data, volumes, an
/// archived material, lines and points, a data URI, cameras, lights and surroundings.
GltfFile everything();

/// Any file with its first node going somewhere.
GltfFile animated(GltfFile file);

struct SeedFile {
  std::string name;
  GltfFile file;
};

/// That file, and one for each way in which a file may hold compressed data. All are whole as a .glb.
std::vector<SeedFile> seed_files();

}  // namespace vernier::test
