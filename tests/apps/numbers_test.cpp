// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"

// Every flag that takes a number, with what is none, is out of range, or could be misread.

namespace vernier::test {
namespace {

using testing::HasSubstr;

struct NumberFlag {
  std::vector<std::string> command;
  std::string flag;
  std::vector<std::string> also_refused = {};  ///< beside what no flag takes
  bool is_list = false;                        ///< numbers with commas between them
};

class Numbers : public testing::TestWithParam<NumberFlag> {};

TEST_P(Numbers, AreTakenOrRefusedInOneLine) {
  std::vector<std::string> values{"nan", "inf", "1e400", "", "0x10", "+-5"};
  if (!GetParam().is_list) values.emplace_back("1,5");
  values.insert(values.end(), GetParam().also_refused.begin(), GetParam().also_refused.end());
  for (const std::string& value : values) {
    std::vector<std::string> arguments = GetParam().command;
    arguments.push_back(GetParam().flag + "=" + value);
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, 2) << GetParam().flag << "=" << value << ": " << result.err;
    EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
    EXPECT_THAT(result.err, testing::StartsWith("error: "));
    EXPECT_EQ(result.out, "");
  }
}

const std::vector<std::string> render_command{"render", cornell_box, "-o", "never.png", "--size", "8x8"};
const std::vector<std::string> bench_command{"bench", "convergence", cornell_box, "--out", "never"};
const std::vector<std::string> whole{"-1", "1.5", "4294967296000", "9223372036854775808"};
const std::vector<std::string> positive{"0", "-1", "1.5", "4294967296000", "9223372036854775808"};

INSTANTIATE_TEST_SUITE_P(
    CommandLine, Numbers,
    testing::Values(
        NumberFlag{render_command, "--spp", positive}, NumberFlag{render_command, "--threads", whole},
        NumberFlag{render_command, "--seed", {"-1", "1.5", "18446744073709551616"}},
        NumberFlag{render_command, "--max-depth", positive}, NumberFlag{render_command, "--ambient", {"-1"}},
        NumberFlag{render_command, "--cutoff", {"-1"}},
        NumberFlag{render_command, "--exposure", {"101", "2147483648"}},
        NumberFlag{render_command, "--env-rotate", {"2147483648"}},
        NumberFlag{render_command, "--env-scale", {"-1"}}, NumberFlag{render_command, "--at", {"2147483648"}},
        NumberFlag{render_command, "--time", {"0", "-1", "5x"}},
        NumberFlag{render_command, "--checkpoint-every", {"0", "-1"}},
        NumberFlag{render_command, "--error", {"0", "-1", "1", "100%", "2147483648"}},
        NumberFlag{render_command, "--size", {"0x0", "-1x5", "8", "8x", "65537x8", "8x2147483648"}},
        NumberFlag{render_command, "--crop", {"8x8", "0x0+0+0", "4x4+-1+0", "8x8+2147483647+0"}},
        NumberFlag{{"compare", "a.exr", "b.exr"}, "--bias-block", positive},
        NumberFlag{{"compare", "a.exr", "b.exr"}, "--bias-level", {"0", "-1", "1", "2147483648"}},
        NumberFlag{bench_command, "--seeds", positive},
        NumberFlag{bench_command, "--times", {"0", "-1", "1,nan"}, true},
        NumberFlag{bench_command, "--reference-spp", positive},
        NumberFlag{{"bench", "calibration", cornell_box}, "--seeds", positive},
        NumberFlag{{"bench", "rays", cornell_box}, "--paths", positive},
        NumberFlag{{"bench", "rays", cornell_box}, "--repetitions", positive},
        NumberFlag{{"bench", "stability"}, "--rays", positive}));

TEST(NumbersMeaning, LeadingZerosAndSigns) {
  const TemporaryFolder folder;
  const ProcessResult result =
      run_vernier({"render", cornell_box, "-o", folder.file("a.png"), "--size", "8x8", "--spp", "010",
                   "--exposure", "+1", "--env-rotate", "0", "--progress", "none"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("8x8, 10 spp"));
}

TEST(WhittedDepth, IsLimitedWhereRaysDouble) {
  const TemporaryFolder folder;
  const auto render = [&](const std::string& integrator, const std::string& depth) {
    return run_vernier({"render", cornell_box, "-o", folder.file("a.exr"), "--size", "4x4", "--spp", "1",
                        "-q", "--integrator", integrator, "--cutoff", "0", "--max-depth", depth});
  };
  EXPECT_EQ(render("whitted", "20").exit_code, 0);
  EXPECT_EQ(render("path", "65536").exit_code, 0);
  const ProcessResult refused = render("whitted", "21");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_EQ(
      refused.err,
      "error: --max-depth: whitted follows at most 20 path vertices, for at each one ray may become two; use "
      "--integrator path\n");
  EXPECT_THAT(run_vernier({"render", "--help"}).out, HasSubstr("whitted: at most 20"));
}

}  // namespace
}  // namespace vernier::test
