// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/support/process.h"

// The check of memory before a render, against what renders take.

namespace vernier::test {
namespace {

using Flags = std::vector<std::string>;

ProcessResult render(const std::string& size, const TemporaryFolder& folder, const Flags& more) {
  Flags arguments{"render",  two_spheres,           "--progress", "none", "-o", folder.file("a.exr"),
                  "--stats", folder.file("a.json"), "--size",     size};
  arguments.insert(arguments.end(), more.begin(), more.end());
  if (std::find(more.begin(), more.end(), "--integrator") == more.end())
    arguments.insert(arguments.end(), {"--integrator", "raycast", "--spp", "17"});
  return run_vernier(arguments);
}

/// What is said of a picture that is too large for any machine.
double estimated_bytes_per_pixel(const TemporaryFolder& folder, const Flags& more) {
  const ProcessResult result = render("65536x65536", folder, more);
  EXPECT_EQ(result.exit_code, 4) << result.err;
  std::smatch found;
  if (!std::regex_search(result.err, found, std::regex("needs ([0-9.]+) ([GT])B of memory"))) {
    ADD_FAILURE() << result.err;
    return 0;
  }
  return std::stod(found[1]) * (found[2] == "T" ? 1e12 : 1e9) / (65536.0 * 65536.0);
}

double peak(const std::string& size, const TemporaryFolder& folder, const Flags& more) {
  const ProcessResult result = render(size, folder, more);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(read_file(folder.file("a.json")))["peak_memory_bytes"];
}

class MemoryCheck : public testing::TestWithParam<Flags> {};

TEST_P(MemoryCheck, IsWhatARenderTakes) {
#ifdef VERNIER_SANITIZED
  GTEST_SKIP() << "sanitizers need memory of their own";
#endif
  const TemporaryFolder folder;
  Flags flags = GetParam();
  for (std::string& flag : flags)
    if (flag.find('.') != std::string::npos) flag = folder.file(flag);
  const double estimated = estimated_bytes_per_pixel(folder, flags);
  // The scene, the libraries and what else does not depend on the picture's size cancel out.
  const double larger = peak("1024x768", folder, flags), smaller = peak("256x192", folder, flags);
  const double taken = (larger - smaller) / (1024 * 768 - 256 * 192);
  EXPECT_LE(taken, 1.02 * estimated);
  EXPECT_GE(taken, estimated / 1.3);
}

INSTANTIATE_TEST_SUITE_P(Memory, MemoryCheck,
                         testing::Values(Flags{}, Flags{"--adaptive", "off"}, Flags{"--aov", "all"},
                                         Flags{"--integrator", "gradient", "--spp", "2", "--max-depth", "1"},
                                         Flags{"-o", "a.png"}, Flags{"--aov", "all", "--report", "a.html"},
                                         Flags{"--denoise", "gaussian", "-o", "a.png"}));

}  // namespace
}  // namespace vernier::test
