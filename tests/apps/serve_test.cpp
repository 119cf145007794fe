// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/image/image_io.h"
#include "tests/apps/serve_support.h"
#include "tests/support/process.h"

namespace vernier {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> small_picture{test::cornell_box, "--size", "32x32", "--spp", "4"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

bool is_complete(const nlohmann::json& picture) { return picture.contains("ended_by"); }

auto complete_picture_of(int view) {
  return [view](const nlohmann::json& picture) { return picture["view"] == view && is_complete(picture); };
}

TEST(Serve, SendsAPageThatLoadsNothingFromElsewhere) {
  const test::RunningServer server(small_picture);
  const auto page = server.get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.header("Content-Type"), StartsWith("text/html"));
  EXPECT_THAT(page.header("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_THAT(page.body, testing::Not(HasSubstr("https://")));
  for (const char* file : {"/serve.js", "/camera.js", "/controls.js", "/stage.js", "/serve.css"})
    EXPECT_EQ(server.get(file).status, 200) << file;
  const auto facts = server.get("/facts").json();
  EXPECT_EQ(facts["file"], test::cornell_box);
  EXPECT_THAT(facts["choices"]["--integrator"], testing::Contains("whitted"));
}

TEST(Serve, TheCommandRendersTheVeryPictureThatIsShown) {
  const test::RunningServer server(small_picture);
  test::EventStream events(server);
  const int view = server
                       .post("/view", R"({"--look-from":"0.4,1.1,3","--look-at":"0,1,-0.2","--fov":"35",
      "--env":"sky","--env-rotate":"30","--exposure":"0.5"})")
                       .json()["view"];
  events.next("picture", complete_picture_of(view));
  const auto shown = server.get("/pixel?x=20&y=22").json();

  auto command = test::EventStream(server).next("view")["command"].get<std::string>();
  const std::string output = "-o picture.png";
  ASSERT_TRUE(command.ends_with(output)) << command;
  const test::TemporaryFolder folder;
  command.replace(command.size() - output.size(), output.size(), "--quiet -o " + folder.file("a.exr"));
  ASSERT_TRUE(command.starts_with("vernier ")) << command;
  const auto result = test::run_process({"/bin/sh", "-c", VERNIER_BINARY + command.substr(7)});
  ASSERT_EQ(result.exit_code, 0) << command << "\n" << result.err;
  const Image picture = read_image(folder.file("a.exr"));
  for (int c = 0; c < 3; ++c) EXPECT_EQ(shown["value"][c].get<float>(), picture.pixel(20, 22)[c]) << command;
}

TEST(Serve, ChangesOfDisplayAndCameraChangeThePicture) {
  const test::RunningServer server(small_picture);
  test::EventStream events(server);
  const auto first = events.next("picture", is_complete);
  const std::string before = server.get("/picture").body;
  EXPECT_THAT(before, StartsWith("\xff\xd8"));  // JPEG

  const int brighter = server.post("/view", R"({"--exposure":"2"})").json()["view"];
  const auto shown = events.next("picture", complete_picture_of(brighter));
  const auto exposed = server.get("/picture");
  EXPECT_NE(exposed.body, before);
  EXPECT_EQ(exposed.header("Vernier-View"), std::to_string(brighter));
  EXPECT_EQ(shown["samples"], first["samples"]) << "exposure takes no new samples";
  EXPECT_EQ(shown["seconds"], first["seconds"]);

  const int moved = server.post("/view", R"({"--look-from":"0,1,2.5","--look-at":"0.3,1,0"})").json()["view"];
  events.next("picture", complete_picture_of(moved));
  EXPECT_NE(server.get("/picture").body, exposed.body);
}

TEST(Serve, FogComesAndGoes) {
  const test::RunningServer server(small_picture);
  EXPECT_GT(server.get("/facts").json()["radius"], 0.1);
  test::EventStream events(server);
  events.next("picture", is_complete);
  const std::string clear = server.get("/picture").body;
  const int foggy = server.post("/view", R"({"--fog":"0.5"})").json()["view"];
  const auto view = events.next("view", [&](const auto& event) { return event["view"] == foggy; });
  EXPECT_EQ(view["values"]["--fog"], "0.5");
  events.next("picture", complete_picture_of(foggy));
  EXPECT_NE(server.get("/picture").body, clear);
  const int clear_again = server.post("/view", R"({"--fog":"","--caustics":"off"})").json()["view"];
  events.next("picture", complete_picture_of(clear_again));
  EXPECT_EQ(server.get("/picture").body, clear);
  EXPECT_EQ(server.post("/view", R"({"--fog":"-1"})").status, 400);
  EXPECT_EQ(server.post("/view", R"({"--caustics":"maybe"})").status, 400);
}

TEST(Serve, TellsWhatAPixelIsAndHowSure) {
  const test::RunningServer server(small_picture);
  test::EventStream events(server);
  const auto picture = events.next("picture", is_complete);
  EXPECT_GT(picture["error"]["rel_rmse"], 0);
  EXPECT_LE(picture["error"]["low"], picture["error"]["rel_rmse"]);
  const auto pixel = server.get("/pixel?x=16&y=30").json();
  EXPECT_EQ(pixel["value"].size(), 3u);
  EXPECT_GT(pixel["error"][1], 0);
  EXPECT_FALSE(pixel["object"].get<std::string>().empty());
  EXPECT_FALSE(pixel["material"].get<std::string>().empty());
  EXPECT_GT(pixel["distance"], 0);
  const auto map = server.get("/error-map");
  EXPECT_THAT(map.body, StartsWith("\xff\xd8"));
  EXPECT_THAT(map.header("Vernier-Largest"), HasSubstr("%"));
}

struct BadRequest {
  const char *target, *body, *headers;
  int status;
  const char* problem;
};

TEST(Serve, RefusesWhatNoPageAsksFor) {
  const test::RunningServer server(small_picture);
  const char* json = "Content-Type: application/json\r\n";
  const BadRequest posts[] = {
      {"/view", "{", json, 400, "expected JSON"},
      {"/view", "[1]", json, 400, "expected an object"},
      {"/view", R"({"--exposure":1})", json, 400, "must be a text"},
      {"/view", R"({"--exposure":"bright"})", json, 400, "is no number"},
      {"/view", R"({"--exposure":"1e9"})", json, 400, "--exposure"},
      {"/view", R"({"--background":"/etc/passwd"})", json, 400, "is no flag that a page may set"},
      {"/view", R"({"--env":"/etc/passwd"})", json, 400, "unknown --env"},
      {"/view", R"({"--size":"9000x9000"})", json, 400, "at most"},
      {"/view", R"({"camera":"nowhere"})", json, 400, "unknown camera"},
      {"/view", "{}", "Content-Type: text/plain\r\n", 415, "application/json"},
      {"/view", "{}", "Content-Type: application/json\r\nOrigin: http://example.com\r\n", 403, "other sites"},
      {"/nothing", "{}", json, 404, "nothing at this address"},
  };
  for (const auto& [target, body, headers, status, problem] : posts) {
    const auto response = server.post(target, body, headers);
    EXPECT_EQ(response.status, status) << body;
    EXPECT_THAT(response.body, HasSubstr(problem)) << body;
  }
  EXPECT_EQ(server.get("/", "Host: example.com\r\n").status, 403)
      << "a name that is made to stand for 127.0.0.1";
  EXPECT_EQ(server.get("/pixel?x=-1&y=z").status, 400);
  EXPECT_EQ(server.post("/view", "{\"--exposure\":\"" + std::string(20000, '1') + "\"}").status, 413);
  EXPECT_EQ(server.get("/" + std::string(20000, 'a')).status, 414);
  for (const char* garbage :
       {"\r\n\r\n", "GET\r\n\r\n", "\x16\x03\x01\x02\x00\x01\xfc\x03", "GET / HTTP/9.9\r\n\r\n"}) {
    const int status = server.exchange(std::string(garbage) + "\r\n\r\n").status;
    EXPECT_TRUE(status == 0 || status >= 400) << status;
  }
  EXPECT_EQ(server.get("/").status, 200) << "it goes on";
}

TEST(Serve, LetsInSixteenPagesAndNoMore) {
  const test::RunningServer server(small_picture);
  std::vector<std::unique_ptr<test::EventStream>> pages;
  for (int i = 0; i < 16; ++i) {
    pages.push_back(std::make_unique<test::EventStream>(server));
    ASSERT_EQ(pages.back()->status(), 200) << i;
  }
  EXPECT_EQ(test::EventStream(server).status(), 503);
  pages.front()->next("picture", is_complete);
  EXPECT_EQ(server.get("/picture").status, 200) << "the others are served";
}

TEST(Serve, OnesThatDoNotReadHoldUpNobody) {
  const test::RunningServer server(small_picture);
  std::vector<test::Connection> silent;
  for (int i = 0; i < 4; ++i) {
    silent.emplace_back(server.port());  // sends nothing
    silent.emplace_back(server.port())
        .send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n\r\n");
  }
  test::EventStream events(server);
  for (int i = 1; i <= 5; ++i) {
    const auto answer = server.post("/view", fmt::format(R"({{"--exposure":"{}"}})", i));
    ASSERT_EQ(answer.status, 200);
    events.next("picture", complete_picture_of(answer.json()["view"]));
  }
}

TEST(Serve, RendersOnlyWhileSomebodyLooks) {
  test::RunningServer server({test::cornell_box, "--size", "32x32", "--time", "1h"});
  const auto rests = [&] {
    const double before = server.processor_seconds();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    return server.processor_seconds() - before < 0.05;
  };
  {
    test::EventStream events(server);
    const double samples = events.next("picture")["samples"];
    EXPECT_GT(events.next("picture")["samples"], samples) << "it goes on while somebody looks";
  }
  int waits = 0;
  while (!rests() && waits < 60) ++waits;
  EXPECT_LT(waits, 60) << "it goes on for nobody";
  test::EventStream(server).next("picture", [](const auto& picture) { return picture["samples"] > 16; });
  EXPECT_EQ(server.end(), 0);
}

TEST(Serve, AskForATokenWhereOthersCanReachIt) {
  const test::RunningServer server(with(small_picture, {"--host", "0.0.0.0"}));
  const std::string target = server.address().substr(server.address().rfind('/'));
  ASSERT_THAT(target, StartsWith("/?token="));
  EXPECT_EQ(server.get("/").status, 401);
  EXPECT_EQ(server.get("/?token=0123456789abcdef0123456789abcdef").status, 401);
  EXPECT_EQ(server.get("/picture" + target.substr(1)).status, 401) << "only the page itself takes it";
  const auto entry = server.get(target);
  EXPECT_EQ(entry.status, 303);
  const std::string cookie = entry.header("Set-Cookie");
  EXPECT_THAT(cookie, HasSubstr("HttpOnly; SameSite=Strict"));
  EXPECT_EQ(server.get("/", "Cookie: a=b; " + cookie.substr(0, cookie.find(';')) + "\r\n").status, 200);
}

TEST(Serve, SaysWhatIsWrongBeforeItServes) {
  const auto serve = [](std::vector<std::string> words) {
    words.insert(words.begin(), "serve");
    return test::run_vernier(words);
  };
  const test::RunningServer server(small_picture);
  const auto taken = serve(with(small_picture, {"--port", std::to_string(server.port())}));
  EXPECT_EQ(taken.exit_code, 3);
  EXPECT_THAT(taken.err, HasSubstr("cannot listen on 127.0.0.1, port " + std::to_string(server.port())));
  EXPECT_EQ(serve({test::cornell_box, "--port", "0", "--panorama"}).exit_code, 2);
  EXPECT_EQ(serve({"no_such_scene.gltf", "--port", "0"}).exit_code, 3);
  EXPECT_EQ(serve({}).exit_code, 2);
}

}  // namespace
}  // namespace vernier
