// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/etc1s.h"

#include "core/ktx2/etc1s_codebook.h"
#include "core/ktx2/etc1s_slice.h"
#include "core/ktx2/texels.h"
#include "vernier/error.h"

namespace vernier::ktx2 {
namespace {

using Bytes = std::span<const uint8_t>;

Error input_error(const std::string& problem) {
  return Error(ErrorKind::input, "KTX2: " + problem + "; the file is damaged");
}

/// What all blocks of a file choose from.
struct Codebooks {
  std::vector<Palette> palettes;
  std::vector<Selectors> selectors;
  SliceTables tables;
};

/// Where the two slices of the base level's picture are.
struct Slices {
  Bytes color, second;
};

/// Hands out the parts of a span one after the other.
class Parts {
 public:
  explicit Parts(Bytes bytes) : rest_(bytes) {}
  Bytes next(uint64_t length) {
    if (length > rest_.size()) throw input_error("the supercompression's global data is cut off");
    const Bytes taken = rest_.first(size_t(length));
    rest_ = rest_.subspan(size_t(length));
    return taken;
  }

 private:
  Bytes rest_;
};

Slices find_slices(Bytes description, const Container& container) {
  constexpr uint32_t depends_on_frame_before = 2;
  const auto field = [&](size_t i) { return read_number<uint32_t>(description, 4 * i); };
  if (field(0) & depends_on_frame_before)
    throw Error(ErrorKind::input, "KTX2: a frame of an animation; a still picture is expected");
  const auto slice = [&](size_t i) {
    const uint64_t offset = field(i), length = field(i + 1);
    if (length == 0 || offset > container.level.size() || length > container.level.size() - offset)
      throw input_error("a slice lies at " + std::to_string(offset) + " with " + std::to_string(length) +
                        " bytes in a level of " + std::to_string(container.level.size()));
    return container.level.subspan(size_t(offset), size_t(length));
  };
  return {slice(1), container.has_second_slice ? slice(3) : Bytes{}};
}

/// Decodes a slice and calls write(block, place) for each of its blocks.
template <typename Write>
void decode_slice(Bytes bytes, const Codebooks& codebooks, Texture& texture, const Write& write) {
  const size_t columns = (size_t{texture.width} + 3) / 4, rows = (size_t{texture.height} + 3) / 4;
  SliceDecoder decoder(codebooks.tables, {codebooks.palettes.size(), codebooks.selectors.size()}, bytes,
                       columns);
  for (size_t y = 0; y < rows; ++y) {
    const auto row = decoder.next_row();
    if (!row) throw input_error("row " + std::to_string(y) + " of the blocks is broken");
    for (size_t x = 0; x < columns; ++x) write((*row)[x], BlockPlace(texture, x, y));
  }
}

}  // namespace

void decode_etc1s(const Container& container, Texture& texture) {
  constexpr size_t header_size = 20, description_size = 20;
  Parts parts(container.global_data);
  const Bytes header = parts.next(header_size);
  const size_t endpoint_count = read_number<uint16_t>(header, 0);
  const size_t selector_count = read_number<uint16_t>(header, 2);
  if (endpoint_count == 0 || selector_count == 0) throw input_error("a codebook is empty");
  const Bytes descriptions = parts.next(uint64_t{description_size} * container.image_count);
  const Slices slices = find_slices(descriptions, container);

  Codebooks codebooks;
  codebooks.palettes = read_palettes(parts.next(read_number<uint32_t>(header, 4)), endpoint_count);
  codebooks.selectors = read_selectors(parts.next(read_number<uint32_t>(header, 8)), selector_count);
  codebooks.tables = SliceTables::read(parts.next(read_number<uint32_t>(header, 12)));

  decode_slice(slices.color, codebooks, texture, [&](const BlockIndices& block, const BlockPlace& place) {
    const Palette& palette = codebooks.palettes[block.endpoint];
    const Selectors& selectors = codebooks.selectors[block.selector];
    for (size_t y = 0; y < place.rows(); ++y) {
      TexelRow row;
      for (size_t x = 0; x < 4; ++x) row[x] = palette[selectors[y] >> 2 * x & 3];
      place.write(y, row);
    }
  });
  if (!container.has_second_slice) return;
  decode_slice(slices.second, codebooks, texture, [&](const BlockIndices& block, const BlockPlace& place) {
    const Palette& palette = codebooks.palettes[block.endpoint];
    const Selectors& selectors = codebooks.selectors[block.selector];
    for (size_t y = 0; y < place.rows(); ++y)
      for (size_t x = 0; x < place.columns(); ++x)
        place.row(y)[4 * x + 3] = palette[selectors[y] >> 2 * x & 3][1];
  });
}

}  // namespace vernier::ktx2
