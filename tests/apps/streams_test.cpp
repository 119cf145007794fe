// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "core/image/image_io.h"
#include "tests/apps/animated_scene.h"
#include "tests/support/process.h"

// Pictures soon, and through standard streams.

namespace vernier::test {
namespace {

using testing::HasSubstr;

class Streams : public testing::Test {
 protected:
  /// Runs `vernier render` by a shell, which can redirect.
  static ProcessResult shell(const std::string& arguments) {
    return run_process(
        {"/bin/sh", "-c",
         std::string(VERNIER_BINARY) + " render --size 16x16 --spp 2 --progress none " + arguments});
  }

  const TemporaryFolder folder_;
};

TEST_F(Streams, StandardOutputTakesThePictureAndNothingElse) {
  const std::string file = folder_.file("a.png"), out = folder_.file("out");
  ASSERT_EQ(shell(cornell_box + " -o " + file).exit_code, 0);
  const ProcessResult result = shell(cornell_box + " -o - > " + out);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("wrote -: 16x16"));
  EXPECT_EQ(read_file(out), read_file(file));
  for (const std::string format : {"exr", "jpg"}) {
    const std::string named = folder_.file("b." + format);
    const std::string outputs = fmt::format(" -o {} -o - --format {} > {}", named, format, out);
    ASSERT_EQ(shell(cornell_box + outputs).exit_code, 0);
    EXPECT_EQ(read_file(out), read_file(named)) << format;
  }
}

TEST_F(Streams, LayersGoToStandardOutputAsExrOnly) {
  const std::string layers = cornell_box + " -o - --aov normal";
  EXPECT_EQ(shell(layers + " > " + folder_.file("out")).exit_code, 2);
  EXPECT_EQ(shell(layers + " --format exr > " + folder_.file("out.exr")).exit_code, 0);
  EXPECT_TRUE(read_layers(folder_.file("out.exr")).layer("N"));
}

TEST_F(Streams, AFullDiskBehindStandardOutputIsAnError) {
  const ProcessResult result = shell(cornell_box + " -o - > /dev/full");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("error: standard output: cannot be written: No space left on device"));
}

TEST_F(Streams, StandardInputIsAScene) {
  const std::string scene = folder_.write("a.glb", animated_scene().glb());
  ASSERT_EQ(shell(scene + " -o " + folder_.file("file.exr")).exit_code, 0);
  const ProcessResult result = shell("- -o " + folder_.file("{name}.exr") + " < " + scene);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_image(folder_.file("stdin.exr")).values, read_image(folder_.file("file.exr")).values);
  const ProcessResult nothing = shell("- -o " + folder_.file("b.exr"));
  EXPECT_EQ(nothing.exit_code, 3);
  EXPECT_THAT(nothing.err, HasSubstr("there is nothing on it"));
}

TEST_F(Streams, DraftIsFewSamplesAndADenoiser) {
  const ProcessResult result =
      run_vernier({"render", cornell_box, "--draft", "--size", "16x16", "-o", folder_.file("a.exr")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  Metadata header = read_layers(folder_.file("a.exr")).metadata;
  EXPECT_EQ(header["vernier:samplesPerPixel"], "8");
  EXPECT_EQ(header["vernier:denoiser"], "nlm");
  EXPECT_EQ(header["vernier:textureFilter"], "mip:1 (approximated)");
  const ProcessResult more =
      run_vernier({"render", cornell_box, "--draft", "--spp", "3", "--denoise", "bilateral",
                   "--texture-filter", "none", "--size", "16x16", "-o", folder_.file("b.exr")});
  EXPECT_EQ(more.exit_code, 0) << more.err;
  header = read_layers(folder_.file("b.exr")).metadata;
  EXPECT_EQ(header["vernier:samplesPerPixel"], "3");
  EXPECT_EQ(header["vernier:denoiser"], "bilateral");
  EXPECT_FALSE(header.contains("vernier:textureFilter"));
  for (const char* exact : {"--strict", "--integrator=light"})
    EXPECT_EQ(
        run_vernier({"render", cornell_box, "--draft", exact, "--size", "8x8", "-o", folder_.file("c.exr")})
            .exit_code,
        0);
}

TEST_F(Streams, PartialPicturesChangeNothingInTheEnd) {
  const std::vector<std::string> run{"render", cornell_box,  "--size", "48x48", "--spp",
                                     "64",     "--progress", "none",   "-o",    folder_.file("a.exr")};
  ASSERT_EQ(run_vernier(run).exit_code, 0);
  const std::string whole = read_file(folder_.file("a.exr"));
  std::vector<std::string> often = run;
  often.insert(often.end(), {"--write-every", "0.001"});
  ASSERT_EQ(run_vernier(often).exit_code, 0);
  EXPECT_EQ(read_file(folder_.file("a.exr")), whole);
}

class WrittenNowBy : public Streams, public testing::WithParamInterface<int> {};

TEST_P(WrittenNowBy, SignalWritesThePictureAndGoesOn) {
  // A checkpoint tells that rendering has begun. It would not end by itself.
  const std::string picture = folder_.file("a.exr"), kept = folder_.file("kept.exr"),
                    checkpoint = folder_.file("a.ckpt");
  const std::string wait_for = "; do kill -0 $job || exit 9; sleep 0.05; done; ";
  const std::string script = std::string(VERNIER_BINARY) + " render " + cornell_box +
                             " --size 32x32 --time 1h --progress none --checkpoint-every 0.01 --checkpoint " +
                             checkpoint + " -o " + picture + " & job=$!; while [ ! -e " + checkpoint + " ]" +
                             wait_for + "kill -" + std::to_string(GetParam()) + " $job; while [ ! -e " +
                             picture + " ]" + wait_for + "cp " + picture + " " + kept +
                             "; kill -TERM $job; wait $job";
  const ProcessResult result = run_process({"/bin/sh", "-c", script});
  EXPECT_EQ(result.exit_code, 5) << result.err;
  EXPECT_EQ(read_layers(kept).metadata.at("vernier:stoppedBy"), "unfinished");
  EXPECT_EQ(read_layers(picture).metadata.at("vernier:stoppedBy"), "interrupted");
}

INSTANTIATE_TEST_SUITE_P(Streams, WrittenNowBy, testing::Values(SIGUSR1, SIGHUP));

}  // namespace
}  // namespace vernier::test
