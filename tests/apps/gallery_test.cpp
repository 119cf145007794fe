// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_io.h"
#include "tests/support/html.h"
#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace vernier::test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Gallery : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return folder_.file(name); }

  /// A picture as a render leaves it.
  void write(const std::string& name, Metadata metadata, int width = 8, int height = 6) const {
    const Image image(width, height, 3);
    if (name.ends_with(".exr"))
      write_exr(file(name), image, {"R", "G", "B"}, metadata);
    else
      write_image8(file(name), Image8(width, height, 3), metadata);
  }
  std::string page(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "gallery");
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(file("index.html"));
  }

  const TemporaryFolder folder_;
};

TEST_F(Gallery, TellsTheErrorAndTheCommandOfEachPicture) {
  for (const std::string extension : {"exr", "png", "jpg"})
    write("a." + extension, {{"vernier:relRmse", "0.0231"},
                             {"vernier:relRmse95", "0.021 0.0262"},
                             {"vernier:samplesPerPixel", "64.01"},
                             {"vernier:missingBentLight", "0.38"},
                             {"vernier:command", "vernier render 'a <b>.glb' -o a." + extension}});
  const std::string html =
      page({file("a.exr"), file("a.png"), file("a.jpg"), "-o", file("index.html"), "--title", "Two & three"});
  EXPECT_THAT(html, Not(testing::ContainsRegex("src=\"[^d]")));  // pictures are inside, as "data:"
  EXPECT_EQ(inline_pictures(html), (std::vector<std::pair<int, int>>(3, {8, 6})));
  EXPECT_THAT(html, HasSubstr("<h1>Two &amp; three</h1>"));
  for (const std::string extension : {"exr", "png", "jpg"}) {
    EXPECT_THAT(html, HasSubstr("<a href=\"a." + extension + "\">"));
    EXPECT_THAT(html, HasSubstr("vernier render 'a &lt;b&gt;.glb' -o a." + extension + "</pre>"));
  }
  EXPECT_THAT(html, HasSubstr("error 2.3 % (2.1 to 2.6 %)</p><p>64.01 samples a pixel</p>"));
  EXPECT_THAT(html, HasSubstr("up to 38 % of all light, behind bending glass, is missing"));
}

TEST_F(Gallery, FramesOfASequenceShareACard) {
  for (const char* name : {"turn.001.png", "turn.002.png", "turn.003.png", "shot1.png", "shot2.png"})
    write(name, {});
  const std::string html = page({file("turn.001.png"), file("turn.002.png"), file("turn.003.png"),
                                 file("shot1.png"), file("shot2.png"), "-o", file("index.html")});
  EXPECT_EQ(inline_pictures(html).size(), 5u);
  EXPECT_THAT(html, HasSubstr("<p>3 frames; of the first:</p>"));
  EXPECT_THAT(html, HasSubstr("<h3>shot1</h3>"));
  EXPECT_THAT(html, HasSubstr("<h3>shot2</h3>"));
  EXPECT_THAT(html, Not(HasSubstr("<h3>turn.002</h3>")));
}

TEST_F(Gallery, LargePicturesAreShownSmallAndLinkedToByAddress) {
  write("a b%.png", {}, 300, 100);
  const std::string html = page({file("a b%.png"), "-o", file("index.html"), "--size", "64"});
  EXPECT_EQ(inline_pictures(html), (std::vector<std::pair<int, int>>{{60, 20}}));
  EXPECT_THAT(html, HasSubstr("<a href=\"a%20b%25.png\">"));
}

TEST_F(Gallery, MisuseIsOneLineAndLeavesNothing) {
  write("a.png", {});
  const std::string broken = folder_.write("broken.png", "no picture");
  const auto refused = [&](std::vector<std::string> arguments, int code, const std::string& text) {
    arguments.insert(arguments.begin(), "gallery");
    const ProcessResult result = run_vernier(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.err, HasSubstr(text));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  refused({"-o", file("index.html")}, 2, "missing PICTURE");
  refused({file("a.png")}, 2, "missing -o FILE.html");
  refused({file("a.png"), "-o", file("a.png")}, 2, "a.png");
  refused({file("a.png"), broken, "-o", file("index.html")}, 3, "broken.png");
  refused({file("a.png"), "-o", file("nowhere/index.html")}, 3, "nowhere/index.html");
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"a.png", "broken.png"}));
}

}  // namespace
}  // namespace vernier::test
