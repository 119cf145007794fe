// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace vernier {
namespace {

TEST(Parallel, CallsEachIndexOnce) {
  std::vector<std::atomic<int>> calls(10'000);
  parallel_for(calls.size(), [&](size_t i) { ++calls[i]; });
  for (const auto& count : calls) ASSERT_EQ(count, 1);
  parallel_for(0, [](size_t) { FAIL(); });
}

TEST(Parallel, ErrorsReachTheCaller) {
  EXPECT_THROW(parallel_for(100,
                            [](size_t i) {
                              if (i == 57) throw std::runtime_error("x");
                            }),
               std::runtime_error);
}

TEST(Parallel, LimitHoldsWhileItLives) {
  const unsigned before = thread_count();
  {
    const ThreadLimit one(1);
    EXPECT_EQ(thread_count(), 1u);
    std::atomic<int> running{0}, most{0};
    parallel_for(1000, [&](size_t) {
      most = std::max(most.load(), ++running);
      --running;
    });
    EXPECT_EQ(most, 1);
  }
  EXPECT_EQ(thread_count(), before);
  EXPECT_GE(before, 1u);
}

}  // namespace
}  // namespace vernier
