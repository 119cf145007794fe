// SPDX-License-Identifier: Apache-2.0
#include "scene/import/texture_memory.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/base/quantities.h"
#include "core/base/resident_memory.h"
#include "scene/import/ordered_parallel.h"

namespace vernier {
namespace {

uint64_t less(uint64_t a, uint64_t b) { return a - std::min(a, b); }

}  // namespace

void TextureMemory::make_room(uint64_t bytes, std::vector<Notice>& notices) {
  if (file_) return;
  // A copy of half the size has a quarter of the texels, and all of them a third.
  const uint64_t needed = limit_.has_mips ? bytes + bytes / 3 : bytes;
  const uint64_t left = less(limit_.bytes, resident_bytes() + scene_bytes_ + limit_.elsewhere);
  if (needed <= left) return;
  // What is left is an estimate, of which a quarter is not taken. With less than so much no picture would
  // ever be done.
  constexpr uint64_t least = uint64_t{16} << 20;
  const uint64_t resident = std::max(left / 4 * 3, least);
  file_ = std::make_shared<PagedFile>(resident);
  notices.push_back(
      {Notice::Severity::info, "/textures",
       fmt::format("textures take {} of memory, of which {} are left: they are kept in a file in "
                   "{} and read from there, at most {} at a time",
                   format_bytes(double(needed)), format_bytes(double(left)), file_->folder(),
                   format_bytes(double(resident)))});
}

void TextureMemory::for_each_that_fits(size_t count, const std::function<uint64_t(size_t)>& bytes,
                                       const std::function<void(size_t)>& decode) const {
  if (!is_limited()) return for_each_in_parallel(count, decode);
  for (size_t begin = 0, end = 0; begin < count; begin = end) {
    const uint64_t left = less(limit_.bytes, resident_bytes());
    // Decoders have the picture once more, in other bits or another order.
    uint64_t taken = 0;
    do {
      taken += 2 * bytes(end++);
    } while (end < count && taken + 2 * bytes(end) <= left);
    for_each_in_parallel(end - begin, [&](size_t i) { decode(begin + i); });
  }
}

}  // namespace vernier
