// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/resource.h>

#include "tests/scene/mutator.h"
#include "tests/scene/seed_files.h"
#include "tests/scene/try_file.h"
#include "tests/support/effort.h"
#include "tests/support/memory_watch.h"

// Damaged scenes: files that use most of what the importer reads, changed at random. Whatever is done to
// them, they are either read into a scene that can be built and traced, or refused by one Error that names
// the file; and neither takes memory out of proportion. MutantSeeds tells how to have more and others.

namespace vernier::test {
namespace {

/// Opens, reads, builds and traces a scene that errors call `name`; returns what it was refused with, nothing
/// when it was not. Anything but an Error goes on to the test.
template <typename... Source>
std::string refusal(const std::string& name, const Source&... bytes) {
  try {
    SceneFile file(name, bytes...);
    try_file(file);
    return {};
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), testing::StartsWith(name + ": "));
    EXPECT_THAT(e.what(), testing::Not(testing::HasSubstr("\n")));
    EXPECT_EQ(e.kind(), ErrorKind::input) << e.what();
    return e.what();
  }
}

/// Of a file in memory, whose end is that of an allocation, so that sanitizers see what reads beyond it.
std::string refusal_in_memory(const std::string& bytes) {
  const std::vector<uint8_t> exact(bytes.begin(), bytes.end());
  return refusal("mutant.glb", std::span<const uint8_t>(exact));
}

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// Reads mutants, of which mutant(seed) makes the bytes; from disk one in sixteen.
template <typename Make>
void expect_read_or_refused(uint64_t usual, const Make& mutant) {
  constexpr size_t gigabyte = size_t{1} << 30;
  const TemporaryFolder folder;
  const long before = peak_megabytes();
  const MutantSeeds seeds(usual);
  uint64_t read = 0;
  for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::string bytes = mutant(seed);
    const MemoryWatch memory;
    EXPECT_NO_THROW(
        read +=
        (seed % 16 == 0 ? refusal(folder.write("scene.glb", bytes)) : refusal_in_memory(bytes)).empty());
    EXPECT_LE(memory.most(), 10 * bytes.size() + gigabyte);
  }
  // Neither all nor none: otherwise the damage is too little or too great to test anything.
  EXPECT_GT(read, seeds.count / 20);
  EXPECT_LT(read, seeds.count - seeds.count / 20);
  // Of all together, what no allocator sees included. AddressSanitizer keeps up to 256 MB of what was freed.
  EXPECT_LT(peak_megabytes() - before, 1024 + 256);
}

GltfFile seed_file(const std::string& name) {
  for (SeedFile& seed : seed_files())
    if (seed.name == name) return std::move(seed.file);
  throw std::invalid_argument(name);
}

/// With one to three changes to the buffer.
void expect_buffers_read_or_refused(uint64_t usual, const std::string& name) {
  const GltfFile original = seed_file(name);
  expect_read_or_refused(usual, [&](uint64_t seed) {
    Mutator mutator(seed);
    GltfFile file = original;
    for (size_t changes = 1 + mutator.below(3); changes > 0; --changes) mutator.change(file.buffer);
    file.json["buffers"][0]["byteLength"] = file.buffer.size();
    return file.glb();
  });
}

TEST(ImportMutations, TheUnchangedFilesAreRead) {
  const TemporaryFolder folder;
  for (const auto& [name, file] : seed_files()) {
    EXPECT_EQ(refusal_in_memory(file.glb()), "") << name;
    EXPECT_EQ(refusal(folder.write("scene.glb", file.glb())), "") << name;
  }
}

TEST(ImportMutations, TheLargestSetOfCoordinatesIsNoNumberBelowZero) {
  GltfFile file = seed_file("everything");
  nlohmann::json& layers = file.json["materials"][0]["extensions"];
  layers["KHR_materials_clearcoat"]["clearcoatTexture"]["texCoord"] = 2147483647;
  EXPECT_EQ(refusal_in_memory(file.glb()), "");
  layers["KHR_materials_clearcoat"]["clearcoatTexture"]["extensions"]["KHR_texture_transform"]["texCoord"] =
      2147483647;
  EXPECT_EQ(refusal_in_memory(file.glb()), "");
}

/// Its z goes from 0 to 2^-125, and half of that was too small for Embree's bins.
TEST(ImportMutations, TheLeastMovementIsNone) {
  GltfFile file = seed_file("draco");
  file.buffer.back() = '\x01';
  EXPECT_EQ(refusal_in_memory(file.glb()), "");
}

TEST(ImportMutations, ChangedJsonIsReadOrRefused) {
  const GltfFile original = seed_file("everything");
  expect_read_or_refused(1000, [&](uint64_t seed) {
    Mutator mutator(seed);
    GltfFile file = original;
    for (size_t changes = 1 + mutator.below(2); changes > 0; --changes) mutator.change(file.json);
    return file.glb();
  });
}

TEST(ImportMutations, ChangedBytesAreReadOrRefused) {
  const std::string original = seed_file("everything").glb();
  expect_read_or_refused(1000, [&](uint64_t seed) {
    Mutator mutator(seed);
    std::string bytes = original;
    for (size_t changes = 1 + mutator.below(2); changes > 0; --changes) mutator.change(bytes);
    return bytes;
  });
}

TEST(ImportMutations, ChangedBuffersAreReadOrRefused) { expect_buffers_read_or_refused(500, "everything"); }
TEST(ImportMutations, ChangedDracoIsReadOrRefused) { expect_buffers_read_or_refused(300, "draco"); }
TEST(ImportMutations, ChangedMeshoptIsReadOrRefused) { expect_buffers_read_or_refused(300, "meshopt"); }
TEST(ImportMutations, ChangedEtc1sIsReadOrRefused) { expect_buffers_read_or_refused(300, "etc1s"); }
TEST(ImportMutations, ChangedUastcIsReadOrRefused) { expect_buffers_read_or_refused(300, "uastc"); }
TEST(ImportMutations, ChangedAvifIsReadOrRefused) { expect_buffers_read_or_refused(300, "avif"); }

/// The JSON beside compressed data says how much of it there is and how it is laid out.
TEST(ImportMutations, ChangedJsonOfCompressedFilesIsReadOrRefused) {
  std::vector<SeedFile> seeds = seed_files();
  seeds.erase(seeds.begin());
  expect_read_or_refused(300, [&](uint64_t seed) {
    Mutator mutator(seed);
    GltfFile file = seeds[seed % seeds.size()].file;
    mutator.change(file.json);
    return file.glb();
  });
}

}  // namespace
}  // namespace vernier::test
