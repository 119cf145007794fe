// SPDX-License-Identifier: Apache-2.0
#include "core/base/file_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using testing::HasSubstr;

/// What is said to a second one that wants the lock; empty when it got it.
std::string refusal(const std::string& file) {
  try {
    const FileLock lock(file);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FileLock, OneAtATime) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("a.ckpt");
  {
    const FileLock lock(file);
    EXPECT_THAT(refusal(file), HasSubstr(file + ": is being written by process " + std::to_string(getpid())));
    EXPECT_EQ(refusal(folder.file("b.ckpt")), "");
  }
  EXPECT_EQ(refusal(file), "");
  EXPECT_THAT(folder.names(), testing::IsEmpty());
}

TEST(FileLock, WhatADeadProcessLeftIsNoLock) {
  const test::TemporaryFolder folder;
  folder.write("a.ckpt.lock", "process 1 on elsewhere");
  EXPECT_EQ(refusal(folder.file("a.ckpt")), "");
  EXPECT_THAT(folder.names(), testing::IsEmpty());
}

TEST(FileLock, WhereItCannotBe) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(refusal(folder.file("none/a.ckpt")), HasSubstr("cannot be written: No such file"));
  EXPECT_EQ(refusal("/dev/null"), "");
}

}  // namespace
}  // namespace vernier
