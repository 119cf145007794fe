// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/level.h"

#include <zstd.h>

#include "vernier/error.h"

namespace vernier::ktx2 {
namespace {

Error input_error(const std::string& problem) {
  return Error(ErrorKind::input, "KTX2: " + problem + "; the file is damaged");
}

std::string size_problem(uint64_t got, const Container& container, size_t size) {
  return "the base level has " + std::to_string(got) + " bytes where " + std::to_string(container.width) +
         "x" + std::to_string(container.height) + " texels take " + std::to_string(size);
}

}  // namespace

Level::Level(const Container& container, size_t size) : bytes_(container.level) {
  if (container.is_zstandard) {
    // Told before anything is allocated, and never more is written than that.
    if (container.uncompressed_size != size)
      throw input_error(size_problem(container.uncompressed_size, container, size));
    decompressed_.resize(size);
    const size_t got = ZSTD_decompress(decompressed_.data(), size, bytes_.data(), bytes_.size());
    if (ZSTD_isError(got))
      throw input_error(std::string("Zstandard says of the base level: ") + ZSTD_getErrorName(got));
    bytes_ = std::span<const uint8_t>(decompressed_).first(got);
  }
  if (bytes_.size() != size) throw input_error(size_problem(bytes_.size(), container, size));
}

}  // namespace vernier::ktx2
