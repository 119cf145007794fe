// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/etc1s_slice.h"

#include <utility>

#include "vernier/error.h"

namespace vernier::ktx2 {

SliceTables SliceTables::read(std::span<const uint8_t> bytes) {
  BitReader bits(bytes);
  SliceTables tables;
  for (HuffmanTable* table :
       {&tables.endpoint_prediction, &tables.endpoint_change, &tables.selector, &tables.selector_run})
    *table = HuffmanTable::read(bits);
  tables.history_size = bits.read(13);
  if (bits.failed())
    throw Error(ErrorKind::input, "KTX2: the Huffman tables of slices are cut off; the file is damaged");
  return tables;
}

SliceDecoder::SliceDecoder(const SliceTables& tables, const CodebookSizes& sizes,
                           std::span<const uint8_t> bytes, size_t row_length)
    : tables_(tables),
      sizes_(sizes),
      bits_(bytes),
      row_(row_length),
      predictions_below_((row_length + 1) / 2),
      history_(tables.history_size),
      history_end_(tables.history_size / 2) {}

std::optional<std::span<const BlockIndices>> SliceDecoder::next_row() {
  uint16_t above_left = 0;
  uint32_t predictions = 0;
  for (size_t x = 0; x < row_.size(); ++x) {
    if (x % 2 == 0) {
      if (is_upper_row_) {
        predictions = next_predictions();
        predictions_below_[x / 2] = uint8_t(predictions >> 4);
      } else {
        predictions = predictions_below_[x / 2];
      }
    }
    const uint16_t above = row_[x].endpoint;
    const uint32_t chosen = endpoint(Prediction(predictions & 3), x, above_left);
    predictions >>= 2;
    row_[x] = {uint16_t(chosen), uint16_t(selector())};
    above_left = above;
    previous_endpoint_ = chosen;
  }
  if (bits_.failed()) return std::nullopt;
  is_upper_row_ = !is_upper_row_;
  is_first_row_ = false;
  return row_;
}

uint32_t SliceDecoder::next_predictions() {
  constexpr uint32_t repeat = 256;
  constexpr uint32_t least_repeats = 3;
  if (repeated_predictions_ > 0) {
    --repeated_predictions_;
    return predictions_;
  }
  const uint32_t symbol = tables_.endpoint_prediction.decode(bits_);
  if (symbol > repeat) bits_.fail();
  if (symbol == repeat)
    repeated_predictions_ = variable_length(4) + least_repeats - 1;
  else
    predictions_ = symbol;
  return predictions_;
}

uint32_t SliceDecoder::endpoint(Prediction prediction, size_t x, uint16_t above_left) {
  switch (prediction) {
    case Prediction::left:
      if (x == 0) bits_.fail();
      return previous_endpoint_;
    case Prediction::above:
      if (is_first_row_) bits_.fail();
      return row_[x].endpoint;
    case Prediction::above_left:
      if (is_first_row_ || x == 0) bits_.fail();
      return above_left;
    case Prediction::none:
      break;
  }
  uint32_t index = previous_endpoint_ + tables_.endpoint_change.decode(bits_);
  if (index >= sizes_.endpoints) index -= uint32_t(sizes_.endpoints);
  if (index < sizes_.endpoints) return index;
  bits_.fail();
  return 0;
}

uint32_t SliceDecoder::selector() {
  constexpr uint32_t least_repeats = 3;
  constexpr uint32_t many_repeats = 63;
  size_t place = 0;  // in the history
  if (repeated_selectors_ > 0) {
    --repeated_selectors_;
  } else {
    const uint32_t symbol = tables_.selector.decode(bits_);
    if (symbol < sizes_.selectors) {
      if (!history_.empty()) {
        history_[history_end_++] = uint16_t(symbol);
        if (history_end_ == history_.size()) history_end_ = history_.size() / 2;
      }
      return symbol;
    }
    place = symbol - sizes_.selectors;
    if (place == history_.size()) {
      const uint32_t run = tables_.selector_run.decode(bits_);
      repeated_selectors_ = (run == many_repeats ? variable_length(7) : run) + least_repeats - 1;
      place = 0;
    }
  }
  if (place >= history_.size()) {
    bits_.fail();
    return 0;
  }
  const uint16_t chosen = history_[place];
  std::swap(history_[place], history_[place / 2]);
  return chosen;
}

uint32_t SliceDecoder::variable_length(int bits_a_time) {
  const uint32_t more = 1u << bits_a_time;
  uint32_t value = 0;
  for (int shift = 0; shift < 32; shift += bits_a_time) {
    const uint32_t chunk = bits_.read(bits_a_time + 1);
    value |= (chunk & (more - 1)) << shift;
    if (chunk < more) return value;
  }
  bits_.fail();
  return 0;
}

}  // namespace vernier::ktx2
