// SPDX-License-Identifier: Apache-2.0
// Checkpoints that nobody wrote: with fingerprints made anew, since these are no secret, so that every check
// behind them is met. A mutant is refused with one line, or is a state from which rendering goes on.
// MutantSeeds tells how to have more and others.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "core/base/fingerprint.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/checkpoint.h"
#include "integrators/render/checkpoint_file.h"
#include "scene/camera.h"
#include "tests/support/effort.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_scenes.h"
#include "vernier/error.h"

namespace vernier::test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

constexpr size_t preamble_size = 48;

/// A checkpoint taken apart, and put together with fingerprints that are right.
struct Parts {
  Json header;
  std::vector<std::string> arrays;

  explicit Parts(const std::string& file) {
    uint32_t length = 0;
    std::memcpy(&length, &file[12], sizeof(length));
    header = Json::parse(file.substr(preamble_size, length));
    size_t at = preamble_size + length;
    for (const Json& array : header["arrays"]) {
      arrays.push_back(file.substr(at, array["bytes"].get<size_t>()));
      at += arrays.back().size();
    }
  }
  /// `text` in place of the header where it is not empty.
  std::string join(std::string text = {}) {
    for (size_t i = 0; i < arrays.size(); ++i) {
      const Json::json_pointer place("/arrays/" + std::to_string(i) + "/fingerprint");
      if (header.contains(place)) header[place] = fingerprint(std::as_bytes(std::span(arrays[i])));
    }
    if (text.empty()) text = header.dump();
    std::string file = "VERNCKPT";
    for (const uint32_t number : {CheckpointPreamble::current_format, uint32_t(text.size())})
      file.append(reinterpret_cast<const char*>(&number), sizeof(number));
    file += fingerprint(std::as_bytes(std::span(text))) + text;
    for (const std::string& array : arrays) file += array;
    return file;
  }
};

/// A state within a pass of an adaptive render of 3 x 2 tiles, and a render to go on with.
class CheckpointMutation : public testing::Test {
 protected:
  CheckpointMutation() {
    options_.width = 36;
    options_.height = 20;
    options_.limits.spp = 40;
    options_.light_split.ways = {"diffuse_direct"};
    CameraDescription view;
    view.to_world.origin = {0, 1, 0.95f};
    camera_.emplace(view, options_.width, options_.height);
    RenderCallbacks callbacks;
    callbacks.on_checkpoint = [&](const RenderState& state) {
      write_checkpoint(file_, {{"seed", "1"}}, state);
    };
    render(scene_, *camera_, *integrator_, options_, stop_, std::move(callbacks));
    bytes_ = read_file(file_);
  }

  /// The complaint, or nothing after a while of rendering from what was read.
  std::string outcome(const std::string& bytes, bool go_on) {
    const std::string path = folder_.write("mutant.ckpt", bytes);
    try {
      Checkpoint checkpoint = read_checkpoint(path);
      const LightSorter sorter(options_.light_split, scene_);
      if (!go_on ||
          !checkpoint.state->fits(options_.width, options_.height, true, false, sorter.layers(), true))
        return {};
      options_.limits.spp = 49;  // through the end of the pass and a planning
      render({scene_, *camera_, *integrator_, options_, Backdrop(options_), sorter}, *checkpoint.state,
             stop_);
      return {};
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_THAT(error.what(), testing::StartsWith(path + ": "));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
  }

  /// Calls damage(seed) for each, with random numbers of its own.
  template <typename Damage>
  void for_each_mutant(const MutantSeeds& seeds, const Damage& damage) {
    for (uint64_t seed = seeds.first; seed < seeds.end(); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      random_.seed(seed);
      damage(seed);
    }
  }

  size_t pick(size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(random_); }

  /// A number, or something else, that somebody might put into a header.
  Json hostile_value() {
    const std::vector<Json> values{0,
                                   1,
                                   2,
                                   15,
                                   65535,
                                   65536,
                                   65537,
                                   1 << 30,
                                   0x7fffffff,
                                   0xffffffffu,
                                   int64_t{1} << 40,
                                   std::numeric_limits<int64_t>::max(),
                                   std::numeric_limits<uint64_t>::max(),
                                   std::numeric_limits<uint64_t>::max() - 7,
                                   -1,
                                   std::numeric_limits<int64_t>::min(),
                                   0.5,
                                   -0.0,
                                   1e300,
                                   nullptr,
                                   true,
                                   false,
                                   "text",
                                   Json::array(),
                                   Json::object(),
                                   Json::array({1, 2, 3})};
    return values[pick(values.size())];
  }

  const Scene scene_ = SceneBuilder()
                           .add(box({-1, 0, -1}, {1, 2, 1}, true), plastic(0.4f))
                           .add(parallelogram({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), emitter(5))
                           .build();
  const std::unique_ptr<Integrator> integrator_ = path({.max_depth = 3, .caustics = Caustics::on});
  RenderSettings options_;
  std::optional<Camera> camera_;
  std::atomic<bool> stop_ = false;
  const TemporaryFolder folder_;
  const std::string file_ = folder_.file("a.ckpt");
  std::string bytes_;
  std::mt19937_64 random_{1};
};

TEST_F(CheckpointMutation, PartsPutTogetherAreTheFile) { EXPECT_EQ(Parts(bytes_).join(), bytes_); }

TEST_F(CheckpointMutation, AnyByteChangedOrAnyLength) {
  for_each_mutant(MutantSeeds(2000), [&](uint64_t seed) {
    std::string mutant = bytes_;
    // Half of them in the header, which is a hundredth of the file.
    for (size_t change = 0; change <= pick(4); ++change)
      mutant[pick(seed % 2 ? mutant.size() : 1500)] = char(pick(256));
    if (mutant != bytes_) {
      EXPECT_NE(outcome(mutant, false), "");
    }
    mutant = bytes_.substr(0, pick(bytes_.size()));
    EXPECT_NE(outcome(mutant, false), "");
    EXPECT_NE(outcome(bytes_ + std::string(1 + pick(100), char(pick(256))), false), "");
  });
}

TEST_F(CheckpointMutation, HostileHeaders) {
  const std::vector<std::string> places{
      "/width",         "/height",         "/adaptive",       "/done",           "/looked_at",
      "/pass",          "/pass/size",      "/pass/odd_half",  "/pass/guiding",   "/seconds",
      "/samples",       "/rays",           "/rays/0",         "/rays/2",         "/bad_samples",
      "/arrays",        "/arrays/0",       "/arrays/0/bytes", "/arrays/3/bytes", "/arrays/4/bytes",
      "/arrays/5/name", "/arrays/5/bytes", "/arrays/6/bytes", "/arrays/7/bytes", "/render",
      "/render/0",      "/render/0/1",     "/has_splats",     "/light_batches",  "/bad_light_paths"};
  const MutantSeeds seeds(3000);
  uint64_t accepted = 0;
  for_each_mutant(seeds, [&](uint64_t) {
    Parts parts(bytes_);
    for (size_t change = 0; change <= pick(3); ++change) {
      const Json::json_pointer place(places[pick(places.size())]);
      if (!parts.header.contains(place)) continue;
      if (pick(10) > 0)
        parts.header[place] = hostile_value();
      else if (!place.parent_pointer().empty())
        parts.header[place.parent_pointer()] = hostile_value();
    }
    accepted += outcome(parts.join(), true).empty();
  });
  EXPECT_GT(accepted, seeds.count / 150) << "else nothing but the first check is met";
}

TEST_F(CheckpointMutation, HostileArrays) {
  const MutantSeeds seeds(2000);
  uint64_t accepted = 0;
  for_each_mutant(seeds, [&](uint64_t seed) {
    Parts parts(bytes_);
    for (size_t change = 0; change <= pick(3); ++change) {
      std::string& array = parts.arrays[pick(parts.arrays.size())];
      if (array.empty()) continue;
      const size_t width = size_t{1} << pick(4), at = pick(array.size() / width) * width;
      const uint64_t patterns[] = {0,
                                   ~uint64_t{0},
                                   0x7ff0000000000000,
                                   0x7f8000007f800000,
                                   0x7fc000007fc00000,
                                   uint64_t{1} << 63 | 1u << 31,
                                   0x7f7fffff7f7fffff,
                                   random_()};
      std::memcpy(&array[at], &patterns[pick(std::size(patterns))], width);
    }
    accepted += outcome(parts.join(), seed % 8 == 0).empty();
  });
  EXPECT_GT(accepted, seeds.count / 100);
}

TEST_F(CheckpointMutation, PartsBeyondThePassNeverComeToAnEnd) {
  Parts parts(bytes_);
  std::memset(parts.arrays[7].data(), 0x7f, 4);
  EXPECT_THAT(outcome(parts.join(), true), HasSubstr("'parts' holds values that no render has"));
}

TEST_F(CheckpointMutation, AHugePassIsRefused) {
  Parts parts(bytes_);
  parts.header["pass"]["size"] = 1 << 29;
  EXPECT_THAT(outcome(parts.join(), true), HasSubstr("'size' is not a whole number from 0 to 32"));
}

TEST_F(CheckpointMutation, SizesThatWrapAreRefused) {
  Parts parts(bytes_);
  parts.header["arrays"][8]["bytes"] = std::numeric_limits<uint64_t>::max() - 95;
  parts.header["arrays"][0]["bytes"] = parts.arrays[0].size() + parts.arrays[8].size() + 96;
  EXPECT_THAT(outcome(parts.join(), false), HasSubstr("is damaged"));
}

TEST_F(CheckpointMutation, HeadersThatAreNotHeaders) {
  Parts parts(bytes_);
  for (const std::string& text :
       {std::string("{}"), std::string("[]"), std::string("null"), std::string("{"), std::string("\xff\xfe"),
        std::string(1 << 20, '['), std::string(1 << 20, ' '), std::string((1 << 20) + 1, ' ')})
    EXPECT_THAT(outcome(parts.join(text), false), HasSubstr("is damaged")) << text.substr(0, 20);
}

// A header of a few hundred bytes may not ask for gigabytes.
TEST_F(CheckpointMutation, NothingIsAllocatedForWhatIsNotThere) {
#ifdef VERNIER_SANITIZED
  GTEST_SKIP() << "sanitizers need all of the address space";
#endif
  Parts parts(bytes_);
  const auto set = [&](size_t array, uint64_t bytes) { parts.header["arrays"][array]["bytes"] = bytes; };
  const uint64_t pixels = uint64_t{60000} * 60000;
  parts.header["width"] = parts.header["height"] = 60000;
  set(0, pixels * 112);
  set(2, pixels * 28);
  set(3, pixels * 28);
  set(4, pixels * 8);
  set(5, uint64_t{3750} * 3750 * 40);
  set(6, pixels * 4);
  set(7, uint64_t{3750} * 3750 * 4);
  for (std::string& array : parts.arrays) array.clear();
  const std::string file = parts.join();
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  rlim_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;  // of the address space that is taken already
  const rlimit one_gigabyte_more{pages * rlim_t(sysconf(_SC_PAGESIZE)) + (rlim_t{1} << 30), before.rlim_max};
  setrlimit(RLIMIT_AS, &one_gigabyte_more);
  const std::string complaint = outcome(file, false);
  setrlimit(RLIMIT_AS, &before);
  EXPECT_THAT(complaint, HasSubstr("it is cut short"));
}

}  // namespace
}  // namespace vernier::test
