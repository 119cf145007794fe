// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/support/process.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;

TEST(VerifyCommand, FindsNoDifferenceThatRoundingDoesNotExcuse) {
  for (const char* scene : {"cornell_box", "layer_spheres"}) {
    const ProcessResult result = run_vernier(
        {"verify", std::string(VERNIER_SOURCE_DIR "/tests/scenes/") + scene + ".gltf", "--rays", "100000"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_THAT(result.out, HasSubstr("embree against bvh, 100 k rays of paths: 0 differ by more"));
  }
}

TEST(VerifyCommand, RefusesWhatAreNotTwoAccelerators) {
  const auto verify = [](const std::string& list) {
    return run_vernier({"verify", cornell_box, "--accelerators", list});
  };
  EXPECT_EQ(verify("bvh").err,
            "error: --accelerators: 'bvh' are not two names; expected two to compare: embree,bvh\n");
  EXPECT_THAT(verify("bvh,embre").err, HasSubstr("did you mean 'embree'"));
  EXPECT_EQ(verify("bvh,embre").exit_code, 2);
  EXPECT_EQ(run_vernier({"verify"}).exit_code, 2);
}

}  // namespace
}  // namespace vernier::test
