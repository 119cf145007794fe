// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/base/parallel.h"
#include "tests/support/process.h"

// Every glTF 2.0 file of Debian's package assimp-testmodels, the broken ones too: none may crash the program.

namespace vernier {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> sample_models() {
  const fs::path folder = "/usr/share/assimp/models/glTF2";
  std::vector<std::string> models;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(folder, error))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb")
      models.push_back(entry.path().string());
  std::sort(models.begin(), models.end());
  return models;
}

/// Success, or exit code 3 with one clear line and nothing written.
void expect_done_or_refused(const std::string& model, const test::ProcessResult& result,
                            const test::TemporaryFolder& folder) {
  EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 3)
      << model << ": " << result.exit_code << result.err;
  if (result.exit_code == 0) return;
  EXPECT_EQ(result.err.find("error: " + model), 0u) << result.err;
  EXPECT_EQ(result.err_lines().size(), 1u) << result.err;
  EXPECT_TRUE(folder.names().empty()) << model;
}

TEST(SampleModels, RenderOrAreRefused) {
  const std::vector<std::string> models = sample_models();
  if (models.empty()) GTEST_SKIP() << "the package assimp-testmodels is not installed";
  std::vector<int> exit_codes(models.size());
  parallel_for(models.size(), [&](size_t i) {
    const test::TemporaryFolder folder;
    const test::ProcessResult result = test::run_vernier(
        {"render", models[i], "-o", folder.file("a.png"), "--spp", "1", "--size", "32x32", "-q"});
    expect_done_or_refused(models[i], result, folder);
    exit_codes[i] = result.exit_code;
  });
  // Most of them are good.
  EXPECT_GT(std::count(exit_codes.begin(), exit_codes.end(), 0), std::ptrdiff_t(models.size() / 2));
}

TEST(SampleModels, AreDescribedOrRefused) {
  const std::vector<std::string> models = sample_models();
  if (models.empty()) GTEST_SKIP() << "the package assimp-testmodels is not installed";
  parallel_for(models.size(), [&](size_t i) {
    const test::TemporaryFolder folder;
    const test::ProcessResult result = test::run_vernier({"info", models[i]});
    expect_done_or_refused(models[i], result, folder);
  });
}

}  // namespace
}  // namespace vernier
