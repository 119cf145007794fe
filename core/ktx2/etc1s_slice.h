// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/ktx2/huffman_table.h"

namespace vernier::ktx2 {

/// Codes that all slices of a file are written in (KTX 2.0, "ETC1S Slice Huffman Tables").
struct SliceTables {
  HuffmanTable endpoint_prediction, endpoint_change, selector, selector_run;
  size_t history_size = 0;

  /// Throws Error(input).
  static SliceTables read(std::span<const uint8_t> bytes);
};

/// What an ETC1S block is: its places in the codebooks.
struct BlockIndices {
  uint16_t endpoint = 0, selector = 0;
};

struct CodebookSizes {
  size_t endpoints = 0, selectors = 0;
};

/// Decodes the blocks of a picture or of its alpha row by row, from the top (KTX 2.0, "ETC1S Slice
/// Decoding").
class SliceDecoder {
 public:
  SliceDecoder(const SliceTables& tables, const CodebookSizes& sizes, std::span<const uint8_t> bytes,
               size_t row_length);

  /// The next row, valid until the one after; indices lie inside the codebooks. Empty: the slice is broken.
  std::optional<std::span<const BlockIndices>> next_row();

 private:
  enum class Prediction { left, above, above_left, none };

  /// Predictions of two by two blocks, two bits each, the upper ones lowest.
  uint32_t next_predictions();
  uint32_t endpoint(Prediction prediction, size_t x, uint16_t above_left);
  uint32_t selector();
  /// Four or seven bits at a time, a further bit tells whether more follow.
  uint32_t variable_length(int bits_a_time);

  const SliceTables& tables_;
  CodebookSizes sizes_;
  BitReader bits_;
  std::vector<BlockIndices> row_;  ///< the row before until it is overwritten
  bool is_upper_row_ = true;       ///< of a pair
  bool is_first_row_ = true;
  std::vector<uint8_t> predictions_below_;  ///< by pairs of columns, for the lower row
  uint32_t predictions_ = 0;                ///< as last decoded
  uint32_t repeated_predictions_ = 0;       ///< how often they hold again
  uint32_t previous_endpoint_ = 0;
  uint32_t repeated_selectors_ = 0;  ///< how often the selectors in front of the history hold again
  std::vector<uint16_t> history_;    ///< selectors that were used, roughly the last in front
  size_t history_end_ = 0;           ///< where the next is put, in the back half
};

}  // namespace vernier::ktx2
