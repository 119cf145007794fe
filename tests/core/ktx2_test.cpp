// SPDX-License-Identifier: Apache-2.0
#include "core/ktx2/ktx2.h"

#include <gmock/gmock.h>
#include <zstd.h>

#include <boost/crc.hpp>

#include "tests/support/ktx2_files.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

namespace field = ktx2_field;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string decode_error(const FileBytes& file, uint64_t max_texels = uint64_t{1} << 28) {
  try {
    ktx2::decode(file, max_texels);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    return e.what();
  }
  return "none";
}

template <typename T>
std::string error_with(FileBytes file, size_t at, T value) {
  put(file, at, value);
  return decode_error(file);
}

FileBytes zstandard(const FileBytes& bytes) {
  FileBytes compressed(ZSTD_compressBound(bytes.size()));
  compressed.resize(ZSTD_compress(compressed.data(), compressed.size(), bytes.data(), bytes.size(), 3));
  return compressed;
}

TEST(Ktx2, TexelsAreThoseOfTheReferenceTranscoder) {
  const auto expectations = ktx2_expectations();
  ASSERT_GE(expectations.size(), 10u);
  for (const Ktx2Expectation& expected : expectations) {
    SCOPED_TRACE(expected.name);
    const ktx2::Texture texture = ktx2::decode(ktx2_fixture(expected.name));
    EXPECT_EQ(texture.width, expected.width);
    EXPECT_EQ(texture.height, expected.height);
    boost::crc_32_type checksum;
    checksum.process_bytes(texture.rgba.data(), texture.rgba.size());
    EXPECT_EQ(checksum.checksum(), expected.checksum);
    EXPECT_TRUE(texture.is_basis_universal);
    EXPECT_THAT(texture.remarks, IsEmpty());
    const bool is_linear = expected.name == "etc1s_grey" || expected.name == "uastc_linear_rdo";
    EXPECT_EQ(texture.transfer, is_linear ? ktx2::TransferFunction::linear : ktx2::TransferFunction::srgb);
  }
}

TEST(Ktx2, PlainTexelsAreThoseOfTheFile) {
  const auto texels = [](uint32_t format, const FileBytes& level) {
    return ktx2::decode(plain_ktx2(2, 1, format, level)).rgba;
  };
  EXPECT_THAT(texels(9, {1, 2}), ElementsAre(1, 0, 0, 255, 2, 0, 0, 255));
  EXPECT_THAT(texels(22, {1, 2, 3, 4}), ElementsAre(1, 2, 0, 255, 3, 4, 0, 255));
  EXPECT_THAT(texels(23, {1, 2, 3, 4, 5, 6}), ElementsAre(1, 2, 3, 255, 4, 5, 6, 255));
  EXPECT_THAT(texels(43, {1, 2, 3, 4, 5, 6, 7, 8}), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  EXPECT_FALSE(ktx2::decode(plain_ktx2(1, 1, 9, {7})).is_basis_universal);

  FileBytes file = plain_ktx2(100, 1, 9, zstandard(FileBytes(100, 77)));
  put(file, field::supercompression, uint32_t{2});
  put(file, field::uncompressed_size, uint64_t{100});
  EXPECT_EQ(ktx2::decode(file).rgba[4 * 99], 77);
}

TEST(Ktx2, GreenIsPutInItsPlace) {
  for (const auto& [name, channels] :
       {std::pair{"etc1s_alpha", std::pair{3, 4}}, {"uastc_zstandard", {5, 0}}}) {
    SCOPED_TRACE(name);
    FileBytes file = ktx2_fixture(name);
    const ktx2::Texture as_color = ktx2::decode(file);
    file[field::channel] = uint8_t((file[field::channel] & 0xf0) | channels.first);
    if (channels.second) file[field::second_channel] = uint8_t(channels.second);
    const ktx2::Texture texture = ktx2::decode(file);
    for (size_t i = 0; i < texture.rgba.size(); i += 4)
      ASSERT_THAT(std::vector<uint8_t>(&texture.rgba[i], &texture.rgba[i] + 4),
                  ElementsAre(as_color.rgba[i], as_color.rgba[i + 3], 0, 255));
  }
}

TEST(Ktx2, TellsWhatGltfForbids) {
  FileBytes file = plain_ktx2(1, 1, 9, {7}, 3);
  EXPECT_EQ(ktx2::decode(file).transfer, ktx2::TransferFunction::other);
  file[field::flags] = 1;
  const std::string orientation("\x11\0\0\0KTXorientation\0ru\0\0\0", 24);
  const std::string swizzle("\x10\0\0\0KTXswizzle\0rgba\0", 20);
  put(file, field::metadata_offset, uint32_t(file.size()));
  put(file, field::metadata_size, uint32_t(orientation.size() + swizzle.size()));
  for (const char c : orientation + swizzle) file.push_back(uint8_t(c));
  EXPECT_THAT(ktx2::decode(file).remarks,
              ElementsAre(HasSubstr("multiplied by alpha"), HasSubstr("KTXorientation is 'ru'")));
}

TEST(Ktx2, RefusesOtherFormatsByName) {
  const FileBytes etc1s = ktx2_fixture("etc1s_gradient"), uastc = ktx2_fixture("uastc_gradient");
  EXPECT_THAT(error_with(etc1s, field::vk_format, 146u), HasSubstr("vkFormat is 146 (BC7)"));
  EXPECT_THAT(error_with(etc1s, field::vk_format, 97u), HasSubstr("vkFormat is 97 (uncompressed)"));
  EXPECT_THAT(error_with(etc1s, field::vk_format, 9u), HasSubstr("supercompression scheme is 1"));
  EXPECT_THAT(error_with(etc1s, field::model, uint8_t{167}), HasSubstr("color model is 167"));
  EXPECT_THAT(error_with(etc1s, field::channel, uint8_t{15}), HasSubstr("channels"));
  EXPECT_THAT(error_with(etc1s, field::supercompression, 2u), HasSubstr("supercompression scheme is 2"));
  EXPECT_THAT(error_with(uastc, field::supercompression, 1u), HasSubstr("supercompression scheme is 1"));
  EXPECT_THAT(error_with(uastc, field::faces, 6u), HasSubstr("cube map"));
  EXPECT_THAT(error_with(uastc, field::depth, 4u), HasSubstr("3D"));
  EXPECT_THAT(error_with(uastc, field::layers, 2u), HasSubstr("array of 2 layers"));
  EXPECT_THAT(error_with(uastc, field::width, 0u), HasSubstr("0x7 has no texels"));
  EXPECT_THAT(error_with(uastc, 0, uint8_t{0}), HasSubstr("signature"));
}

TEST(Ktx2, RefusesWhatLiesBeyondTheFile) {
  const FileBytes file = ktx2_fixture("etc1s_alpha");
  for (const auto& [at, name] : {std::pair{field::global_offset, "global data"},
                                 {field::global_size, "global data"},
                                 {field::level_offset, "base level"},
                                 {field::level_size, "base level"}})
    for (const uint64_t value : {uint64_t{1} << 20, uint64_t{1} << 63, ~uint64_t{0}})
      EXPECT_THAT(error_with(file, at, value), HasSubstr(name));
  for (const size_t at :
       {field::descriptor_offset, field::descriptor_size, field::metadata_size, field::levels})
    EXPECT_THAT(error_with(file, at, 0xffffffffu), HasSubstr("damaged"));
  for (size_t size = 0; size < file.size(); ++size)
    ASSERT_NE(decode_error(FileBytes(file.begin(), file.begin() + ptrdiff_t(size))), "none") << size;
}

TEST(Ktx2, AllocatesNoMoreThanTheFileCanJustify) {
  const FileBytes etc1s = ktx2_fixture("etc1s_gradient");
  FileBytes large = etc1s;
  put(large, field::width, 1u << 13);
  put(large, field::height, 1u << 13);
  EXPECT_THAT(decode_error(large), HasSubstr("hostile"));
  put(large, field::width, 0xffffffffu);
  put(large, field::height, 0xffffffffu);
  EXPECT_THAT(decode_error(large), HasSubstr("beyond the limit of 268435456 texels"));
  EXPECT_THAT(decode_error(etc1s, 24 * 20 - 1), HasSubstr("beyond the limit of 479 texels"));
  EXPECT_EQ(decode_error(etc1s, 24 * 20), "none");
}

TEST(Ktx2, ZstandardYieldsWhatTheSizeTakesOrNothing) {
  const auto file_of = [](const FileBytes& blocks, uint64_t claimed) {
    FileBytes file = ktx2_fixture("uastc_zstandard");
    const FileBytes level = zstandard(blocks);
    put(file, field::level_offset, uint64_t{file.size()});
    put(file, field::level_size, uint64_t{level.size()});
    put(file, field::uncompressed_size, claimed);
    file.insert(file.end(), level.begin(), level.end());
    return file;
  };
  constexpr size_t size = 8 * 7 * 16;  // of 30 x 26 texels
  EXPECT_EQ(decode_error(file_of(FileBytes(size, 0), size)), "none");
  EXPECT_THAT(decode_error(file_of(FileBytes(size - 1, 0), size)), HasSubstr("has 895 bytes"));
  EXPECT_THAT(decode_error(file_of(FileBytes(size, 0), size + 1)), HasSubstr("has 897 bytes"));
  // A bomb: 64 MB in some kilobytes.
  EXPECT_THAT(decode_error(file_of(FileBytes(size_t{1} << 26, 0), size)), HasSubstr("too small"));
}

TEST(Ktx2, RefusesBlocksOfNoMode) {
  FileBytes file = ktx2_fixture("uastc_gradient");
  const size_t last = file.size() - 16;
  file[last] = 69;  // the reserved mode
  EXPECT_THAT(decode_error(file), HasSubstr("block 1 of row 1 is of no mode"));
  put(file, last, 29u | 30u << 20);  // a mode of 30 patterns
  EXPECT_THAT(decode_error(file), HasSubstr("block 1 of row 1 is of no mode"));
  put(file, last, 29u | 29u << 20);
  EXPECT_EQ(decode_error(file), "none");
}

}  // namespace
}  // namespace vernier::test
