// SPDX-License-Identifier: Apache-2.0
#include "core/image/paged_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "tests/support/file_size_limit.h"
#include "tests/support/random.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

/// TMPDIR while it lives.
class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(const std::string& folder) {
    if (const char* before = std::getenv("TMPDIR")) before_ = before;
    setenv("TMPDIR", folder.c_str(), 1);
  }
  ~TemporaryDirectory() { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

 private:
  std::string before_;
};

template <typename T>
BasicImage<T> noise(int width, int height, int channels) {
  BasicImage<T> image(width, height, channels);
  Random random(uint64_t(width * 7 + height * 3 + channels));
  for (T& value : image.values) value = T(uint32_t(random.next1() * 65536));
  return image;
}

template <typename T>
void expect_same_texels() {
  for (int channels = 1; channels <= 4; ++channels)
    for (const auto& [width, height] : {std::pair(1, 1), {300, 1}, {1, 300}, {129, 127}, {513, 257}}) {
      const BasicImage<T> image = noise<T>(width, height, channels);
      const PagedImage<T> paged(image, std::make_shared<PagedFile>(PagedFile::block_bytes));
      EXPECT_EQ(paged.unpacked().values, image.values) << width << "x" << height << "x" << channels;
      for (const auto& [x, y] : {std::pair(0, 0), {width - 1, 0}, {0, height - 1}, {width / 2, height / 3}})
        for (int c = 0; c < channels; ++c) EXPECT_EQ(paged.texel(x, y)[c], image.pixel(x, y)[c]);
    }
}

TEST(PagedImage, HasTheTexelsOfThePicture) {
  expect_same_texels<uint8_t>();
  expect_same_texels<uint16_t>();
}

/// Bytes that the process holds of files.
size_t resident_of_files() {
  std::ifstream stream("/proc/self/statm");
  size_t all = 0, resident = 0, of_files = 0;
  stream >> all >> resident >> of_files;
  return of_files * size_t(sysconf(_SC_PAGESIZE));
}

TEST(PagedImage, HoldsNoMoreThanItMay) {
  constexpr size_t most = 32 * PagedFile::block_bytes;
  const Image8 image = noise<uint8_t>(4096, 2048, 4);
  const PagedImage<uint8_t> paged(image, std::make_shared<PagedFile>(most));
  ASSERT_GT(image.values.size(), 15 * most);
  size_t peak = 0;
  const size_t before = resident_of_files();
  for (int y = 0; y < image.height; y += 8) {
    for (int x = 0; x < image.width; x += 8) ASSERT_EQ(*paged.texel(x, y), *image.pixel(x, y));
    peak = std::max(peak, resident_of_files());
  }
  // The kernel counts on each processor apart and tells the sum to some pages; code is read from files too.
  constexpr size_t inexact = 1 << 20;
  EXPECT_LE(peak - before, most + PagedFile::block_bytes + inexact);
  EXPECT_GE(peak - before, most / 4) << "what is held is not what was read";
}

TEST(PagedImage, CanBeReadByManyThreads) {
  const Image16 image = noise<uint16_t>(1000, 700, 3);
  const PagedImage<uint16_t> paged(image, std::make_shared<PagedFile>(4 * PagedFile::block_bytes));
  std::vector<size_t> wrong(4);
  std::vector<std::thread> threads;
  for (size_t t = 0; t < wrong.size(); ++t)
    threads.emplace_back([&, t] {
      Random random(t);
      for (int i = 0; i < 20000; ++i) {
        const Vec2f at = random.next2();
        const int x = int(at.x * 1000), y = int(at.y * 700);
        wrong[t] += !std::equal(paged.texel(x, y), paged.texel(x, y) + 3, image.pixel(x, y));
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<size_t>(4));
}

TEST(PagedFile, LeavesNothingBehind) {
  const TemporaryFolder folder;
  const TemporaryDirectory directory(folder.path().string());
  const auto file = std::make_shared<PagedFile>(PagedFile::block_bytes);
  const PagedImage<uint8_t> paged(noise<uint8_t>(100, 100, 3), file);
  EXPECT_EQ(file->folder(), folder.path().string());
  EXPECT_EQ(file->size(), 49152u) << "sixteen tiles of 32 x 32 texels of three bytes";
  EXPECT_TRUE(folder.names().empty());
}

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::output);
    return error.what();
  }
  return {};
}

TEST(PagedFile, SaysWhatIsWrongWithTheDisk) {
  const TemporaryFolder folder;
  {
    const TemporaryDirectory directory(folder.file("missing"));
    EXPECT_THAT(error_of([] { PagedFile file(1); }), HasSubstr("missing: no file for textures can be made"));
  }
  const TemporaryDirectory directory(folder.path().string());
  const auto file = std::make_shared<PagedFile>(PagedFile::block_bytes);
  const FileSizeLimit full(1 << 20);
  const std::string error =
      error_of([&] { const PagedImage<uint8_t> paged(noise<uint8_t>(1024, 1024, 4), file); });
  EXPECT_THAT(error, HasSubstr("textures cannot be written after 1.1"));
  EXPECT_THAT(error, HasSubstr("set TMPDIR to a folder where there is room"));
}

TEST(PagedFile, IsNotHeldInMemory) {
  struct statfs system {};
  constexpr long tmpfs = 0x01021994;  // linux/magic.h
  if (::statfs("/dev/shm", &system) != 0 || system.f_type != tmpfs) GTEST_SKIP() << "/dev/shm is none";
  const TemporaryDirectory directory("/dev/shm");
  EXPECT_THAT(error_of([] { PagedFile file(1); }), HasSubstr("/dev/shm: is held in memory"));
}

}  // namespace
}  // namespace vernier::test
