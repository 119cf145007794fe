// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "core/ktx2/huffman_table.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using ktx2::BitReader;
using ktx2::HuffmanTable;
using testing::HasSubstr;

/// The opposite of BitReader.
class BitWriter {
 public:
  void write(uint32_t value, int count) {
    for (int i = 0; i < count; ++i) {
      if (bits_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() |= uint8_t((value >> i & 1) << bits_++ % 8);
    }
  }
  /// A Huffman code, which begins with its highest bit.
  void write_code(uint32_t code, int length) {
    for (int i = length; i-- > 0;) write(code >> i & 1, 1);
  }
  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
  size_t bits_ = 0;
};

/// A table of code lengths (or of the runs that 17 and up stand for), sent by a complete code of eleven codes
/// of four bits, for 0 to 10, and ten of five.
void write_table(BitWriter& bits, const std::vector<uint32_t>& lengths) {
  bits.write(uint32_t(lengths.size()), 14);
  bits.write(21, 5);
  const uint32_t order[] = {17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16};
  for (const uint32_t symbol : order) bits.write(symbol < 11 ? 4 : 5, 3);
  for (const uint32_t length : lengths) {
    if (length < 11)
      bits.write_code(length, 4);
    else
      bits.write_code(22 + length - 11, 5);
  }
}

std::string table_error(const std::vector<uint32_t>& lengths) {
  BitWriter bits;
  write_table(bits, lengths);
  BitReader reader(bits.bytes());
  try {
    HuffmanTable::read(reader);
  } catch (const Error& e) {
    return e.what();
  }
  return "none";
}

TEST(Ktx2Huffman, CodesOfEveryLengthAreRead) {
  // 0, 10, 110, ... up to two codes of sixteen bits.
  std::vector<uint32_t> lengths;
  for (uint32_t length = 1; length <= 16; ++length) lengths.push_back(length);
  lengths.push_back(16);
  BitWriter bits;
  write_table(bits, lengths);
  for (uint32_t symbol = 0; symbol < 17; ++symbol) {
    const int ones = int(std::min(symbol, 16u));
    bits.write_code((1u << ones) - 1, ones);
    if (symbol < 16) bits.write_code(0, 1);
  }
  BitReader reader(bits.bytes());
  const HuffmanTable table = HuffmanTable::read(reader);
  for (uint32_t symbol = 0; symbol < 17; ++symbol) EXPECT_EQ(table.decode(reader), symbol);
  EXPECT_FALSE(reader.failed());
}

TEST(Ktx2Huffman, RefusesImpossibleTables) {
  EXPECT_EQ(table_error({1, 2, 2}), "none");
  EXPECT_EQ(table_error({0, 1, 0}), "none") << "a single symbol has half of the codes";
  EXPECT_THAT(table_error({1, 1, 2}), HasSubstr("too many codes"));
  EXPECT_THAT(table_error({1, 2, 3}), HasSubstr("codes without a symbol"));
  EXPECT_THAT(table_error({19}), HasSubstr("repeats a code length where there is none"));
  EXPECT_THAT(table_error({0, 20}), HasSubstr("repeats a code length where there is none"));
  EXPECT_THAT(table_error({1, 1, 17}), HasSubstr("more code lengths than symbols"));
  BitWriter bits;
  bits.write(5, 14);
  bits.write(0, 5);
  BitReader reader(bits.bytes());
  EXPECT_THROW(HuffmanTable::read(reader), Error);
}

TEST(Ktx2Huffman, BitsThatAreNoCodeFail) {
  BitWriter bits;
  write_table(bits, {0, 1});
  bits.write(0, 1);
  bits.write(1, 1);
  BitReader reader(bits.bytes());
  const HuffmanTable table = HuffmanTable::read(reader);
  EXPECT_EQ(table.decode(reader), 1u);
  EXPECT_FALSE(reader.failed());
  table.decode(reader);
  EXPECT_TRUE(reader.failed());
}

TEST(Ktx2Huffman, ReadingBeyondTheEndFails) {
  for (size_t size = 0; size < 20; ++size) {
    const std::vector<uint8_t> bytes(size, 0xff);
    BitReader reader(bytes);
    for (size_t bit = 0; bit < 8 * size; ++bit) ASSERT_EQ(reader.read(1), 1u);
    EXPECT_FALSE(reader.failed());
    EXPECT_EQ(reader.read(1), 0u);
    EXPECT_TRUE(reader.failed());
  }
}

}  // namespace
}  // namespace vernier::test
