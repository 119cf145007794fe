// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "core/base/parallel.h"
#include "core/denoise/denoise_filters.h"
#include "core/denoise/oidn_library.h"
#include "tests/oidn/double.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"
#include "vernier/error.h"

// The adapter to Open Image Denoise with a double of that library in its place. What the network makes of a
// picture is tested where the library is found: tests/core/denoise_test.cpp, apps/python/tests.

namespace vernier {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Image picture(float value) {
  Image image(5, 4, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}

/// The double, named by the environment before anything looks for the library.
test::OidnRecord& record() {
  static test::OidnRecord* const result = [] {
    setenv("VERNIER_OIDN", VERNIER_OIDN_DOUBLE, 1);
    void* const handle = dlopen(VERNIER_OIDN_DOUBLE, RTLD_NOW);
    const auto get = reinterpret_cast<OidnRecordFunction>(handle ? dlsym(handle, oidn_record_name) : nullptr);
    if (!get) throw std::runtime_error("the double of Open Image Denoise cannot be loaded");
    return get();
  }();
  return *result;
}

class DenoiseOidn : public testing::Test {
 protected:
  DenoiseOidn() { record() = {}; }
  const std::vector<std::string>& calls() const { return record().calls; }
};

TEST_F(DenoiseOidn, IsFoundWhereTheEnvironmentSays) {
  ASSERT_TRUE(OidnLibrary::find());
  EXPECT_EQ(OidnLibrary::find()->path, VERNIER_OIDN_DOUBLE);
  EXPECT_EQ(find_denoiser("auto").name, "oidn");
  EXPECT_EQ(denoisers().back().name, "oidn");
}

/// What the command says of its filters in an environment.
std::string told_filters(const std::string& variable, const std::string& value) {
  const std::string named = std::getenv("VERNIER_OIDN");
  unsetenv("VERNIER_OIDN");
  setenv(variable.c_str(), value.c_str(), 1);
  const test::ProcessResult told = test::run_vernier({"denoise", "--filter", "help"});
  unsetenv(variable.c_str());
  setenv("VERNIER_OIDN", named.c_str(), 1);
  EXPECT_EQ(told.exit_code, 0) << told.err;
  return told.out;
}

TEST_F(DenoiseOidn, IsFoundInAPythonEnvironment) {
  const test::TemporaryFolder environment;
  const std::filesystem::path folder(environment.file("lib/python3.12/site-packages/pyoidn/oidn/lib"));
  std::filesystem::create_directories(folder);
  std::filesystem::create_symlink(VERNIER_OIDN_DOUBLE, folder / "libOpenImageDenoise.so.2");
  EXPECT_THAT(told_filters("VIRTUAL_ENV", environment.path().string()), HasSubstr("a trained network"));
  EXPECT_THAT(told_filters("VERNIER_OIDN", folder.string()), HasSubstr("a trained network"));
}

TEST_F(DenoiseOidn, WhyItIsNotThereIsTold) {
  EXPECT_THAT(told_filters("VERNIER_OIDN", ""), HasSubstr("not here: VERNIER_OIDN is empty"));
  EXPECT_THAT(told_filters("VERNIER_OIDN", "/missing.so"), HasSubstr("not here: VERNIER_OIDN: /missing.so"));
  EXPECT_THAT(told_filters("VERNIER_OIDN", "libm.so.6"), HasSubstr("libm.so.6 has no function oidn"));
}

TEST_F(DenoiseOidn, AsksInTheLibrarysOrder) {
  const ThreadLimit threads(2);
  const Image result = denoise_oidn({picture(3), picture(1), picture(0.5f), picture(0.6f)});
  EXPECT_THAT(calls(), ElementsAre("new CPU device", "numThreads 2", "setAffinity off", "commit device",
                                   "new filter RT", "image color 5x4 float3", "image albedo 5x4 float3",
                                   "image normal 5x4 float3", "image output 5x4 float3", "hdr on",
                                   "commit filter", "execute", "release filter", "release device"));
  EXPECT_EQ(result.values, picture(1.5f).values);
}

TEST_F(DenoiseOidn, NormalsWithoutAlbedoAreLeftOut) {
  denoise_oidn({picture(1), {}, {}, picture(0.6f)});
  EXPECT_THAT(calls(), testing::Not(testing::Contains(HasSubstr("image normal"))));
  EXPECT_THAT(calls(), testing::Contains("execute"));
}

TEST_F(DenoiseOidn, PixelsThatAreNotFiniteTakeTheirNeighboursMean) {
  NoisyImage noisy{picture(4)};
  noisy.color.pixel(2, 2)[1] = NAN;
  EXPECT_EQ(denoise_oidn(noisy).values, picture(2).values);
}

TEST_F(DenoiseOidn, SizesMustAgree) {
  EXPECT_THROW(denoise_oidn({picture(1), {}, Image(5, 5, 3)}), Error);
  EXPECT_THAT(calls(), ElementsAre());
}

TEST_F(DenoiseOidn, WhatFailsIsToldAndReleased) {
  for (const char* call : {"new CPU device", "commit device", "new filter RT", "commit filter", "execute"})
    for (const int failure : {1, 4}) {  // unknown, out of memory
      record() = {{}, call, failure};
      try {
        denoise_oidn({picture(1)});
        ADD_FAILURE() << call;
      } catch (const Error& error) {
        EXPECT_THAT(error.what(), HasSubstr("Open Image Denoise: the double fails")) << call;
        EXPECT_EQ(error.kind(), failure == 4 ? ErrorKind::memory : ErrorKind::usage);
      }
      std::string last = call;
      for (const std::string& next : calls())
        if (next != "release filter" && next != "release device") last = next;
      EXPECT_EQ(last, call) << "nothing is asked after a failure";
      const auto count = [&](const std::string& name) {
        return std::count(calls().begin(), calls().end(), name);
      };
      const bool device = calls().size() > 1, filter = count("image color 5x4 float3") == 1;
      EXPECT_EQ(count("release device"), device);
      EXPECT_EQ(count("release filter"), filter);
    }
}

// Both halves are halved: the estimate sees the half of the light that is missing.
TEST_F(DenoiseOidn, ErrorIsEstimatedAsOfAnyFilter) {
  const DenoisedHalves halves = denoise_halves({"oidn", "", denoise_oidn, true}, {picture(1)}, {picture(1)});
  EXPECT_EQ(halves.picture.values, picture(0.5f).values);
  EXPECT_GT(halves.error.rel_rmse, 0.5);
}

}  // namespace
}  // namespace vernier
