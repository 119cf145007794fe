// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <random>

#include "core/ktx2/ktx2.h"
#include "tests/support/effort.h"
#include "tests/support/ktx2_files.h"
#include "vernier/error.h"

// Damaged KTX2 files: the fixtures, changed at random, in their headers and codebooks more than in the
// blocks. Whatever is done to one, it is either decoded to the size that it tells or refused by one Error.
// MutantSeeds tells how to have more and others.

namespace vernier::test {
namespace {

using testing::Not;
using testing::StartsWith;

class Mutator {
 public:
  explicit Mutator(uint64_t seed) : engine_(seed) {}

  /// Some bits, bytes or numbers become others, or a stretch of bytes is lost or doubled.
  void change(FileBytes& file, size_t from) {
    const size_t at = from + below(file.size() - from), count = std::min(1 + below(16), file.size() - at);
    const auto place = file.begin() + ptrdiff_t(at);
    const FileBytes stretch(place, place + ptrdiff_t(count));
    switch (below(6)) {
      case 0:
        file[at] ^= uint8_t(1 << below(8));
        break;
      case 1:
        file[at] = uint8_t(engine_());
        break;
      case 2:
        overwrite(file, at, uint32_t(below(2) ? below(1 << 16) : ~below(300)));
        break;
      case 3:
        overwrite(file, at, below(2) ? engine_() : ~uint64_t{below(300)});
        break;
      case 4:
        file.insert(place, stretch.begin(), stretch.end());
        break;
      default:
        file.erase(place, place + ptrdiff_t(count));
    }
  }

  size_t below(size_t n) { return size_t(engine_() % n); }

 private:
  template <typename T>
  void overwrite(FileBytes& file, size_t at, T value) {
    at = at / sizeof(T) * sizeof(T);
    if (at + sizeof(T) <= file.size()) put(file, at, value);
  }

  std::mt19937_64 engine_;
};

long peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// True when the file was not refused.
bool survives(const FileBytes& file) {
  try {
    const ktx2::Texture texture = ktx2::decode(file, 1 << 20);
    EXPECT_EQ(texture.rgba.size(), size_t{texture.width} * texture.height * 4);
    return true;
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_THAT(e.what(), StartsWith("KTX2: "));
    EXPECT_THAT(e.what(), Not(testing::HasSubstr("\n")));
    return false;
  }
}

/// Mutants whose bytes before `from` stay.
void expect_decoded_or_refused(uint64_t usual, size_t from) {
  std::vector<FileBytes> originals;
  for (const auto& expected : ktx2_expectations()) originals.push_back(ktx2_fixture(expected.name));
  const long before = peak_megabytes();
  const MutantSeeds seeds(usual);
  uint64_t decoded = 0;
  for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Mutator mutator(seed);
    FileBytes file = originals[mutator.below(originals.size())];
    for (size_t changes = 1 + mutator.below(3); changes > 0; --changes) mutator.change(file, from);
    EXPECT_NO_THROW(decoded += survives(file));
  }
  // Neither all nor none: otherwise the damage is too little or too great to test anything.
  EXPECT_GT(decoded, seeds.count / 20);
  EXPECT_LT(decoded, seeds.count - seeds.count / 20);
  // Files of kilobytes; AddressSanitizer keeps up to 256 MB of what was freed.
  EXPECT_LT(peak_megabytes() - before, 512);
}

TEST(Ktx2Mutations, ChangedFilesAreDecodedOrRefused) { expect_decoded_or_refused(20000 / thinning, 0); }

TEST(Ktx2Mutations, ChangedContentsAreDecodedOrRefused) { expect_decoded_or_refused(20000 / thinning, 160); }

}  // namespace
}  // namespace vernier::test
