// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/guard.h"

#include <gtest/gtest.h>

namespace vernier::apps {
namespace {

int allowed(RateLimit& limit, const std::string& address, RateLimit::Clock::time_point now, int asked) {
  int count = 0;
  for (int i = 0; i < asked; ++i) count += limit.allows(address, now);
  return count;
}

TEST(RateLimit, AllowsABurstAndThenSoManyASecond) {
  RateLimit limit;
  const RateLimit::Clock::time_point start{};
  EXPECT_EQ(allowed(limit, "a", start, 1000), 600);
  EXPECT_EQ(allowed(limit, "b", start, 1000), 600) << "another address";
  EXPECT_EQ(allowed(limit, "a", start + std::chrono::milliseconds(500), 1000), 150);
  EXPECT_EQ(allowed(limit, "a", start + std::chrono::hours(1), 1000), 600);
}

TEST(RateLimit, ForgetsAddressesRatherThanGrow) {
  RateLimit limit;
  RateLimit::Clock::time_point now{};
  EXPECT_EQ(allowed(limit, "first", now, 600), 600);
  for (int i = 0; i < 1024; ++i) limit.allows(std::to_string(i), now += std::chrono::nanoseconds(1));
  EXPECT_TRUE(limit.allows("first", now)) << "the oldest is forgotten";
  EXPECT_FALSE(allowed(limit, "1023", now, 600) == 600) << "the newest is not";
}

RequestHead page_request(const std::string& host) {
  return {.remote = "127.0.0.1",
          .method = "GET",
          .path = "/",
          .host = host,
          .origin = "",
          .content_type = "",
          .cookie = "",
          .token = ""};
}

int status(Guard& guard, const RequestHead& request) {
  const auto refusal = guard.refusal(request);
  return refusal ? refusal->status : 200;
}

TEST(Guard, TakesNoOtherNameForThisMachine) {
  Guard guard("", 8080);
  for (const char* host : {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "127.1.2.3:8080"})
    EXPECT_EQ(status(guard, page_request(host)), 200) << host;
  for (const char* host : {"", "example.com", "example.com:8080", "127.0.0.1", "127.0.0.1:80",
                           "127.0.0.1.example.com:8080", "localhost.example.com:8080"})
    EXPECT_EQ(status(guard, page_request(host)), 403) << host;
}

TEST(Guard, RefusesOtherSitesAndOtherTypes) {
  Guard guard("", 8080);
  RequestHead request = page_request("localhost:8080");
  request.origin = "http://localhost:8080";
  EXPECT_EQ(status(guard, request), 200);
  for (const char* origin :
       {"http://localhost:8081", "https://localhost:8080", "null", "http://example.com"}) {
    request.origin = origin;
    EXPECT_EQ(status(guard, request), 403) << origin;
  }
  request = page_request("localhost:8080");
  request.method = "POST";
  EXPECT_EQ(status(guard, request), 415);
  request.content_type = "application/json; charset=utf-8";
  EXPECT_EQ(status(guard, request), 200);
}

TEST(Guard, TakesItsTokenFromThePageOrACookie) {
  const std::string token = "0123456789abcdef0123456789abcdef";
  Guard guard(token, 8080);
  RequestHead request = page_request("machine:8080");
  EXPECT_EQ(status(guard, request), 401);
  for (const std::string& wrong : {token.substr(1), token + "0", std::string(32, '0'), std::string()}) {
    request.token = wrong;
    EXPECT_EQ(status(guard, request), 401) << wrong;
    request.cookie = "vernier_8080=" + wrong;
    EXPECT_EQ(status(guard, request), 401) << wrong;
  }
  request.cookie = "";
  request.token = token;
  EXPECT_EQ(status(guard, request), 200);
  request.path = "/picture";
  EXPECT_EQ(status(guard, request), 401) << "the token stands in no other address";
  request.token = "";
  request.cookie = "a=b; vernier_8080=" + token + "; c=d";
  EXPECT_EQ(status(guard, request), 200);
  request.cookie = "vernier_8081=" + token;
  EXPECT_EQ(status(guard, request), 401) << "of a server on another port";
}

TEST(Guard, TokensAreLongAndDiffer) {
  EXPECT_EQ(make_token().size(), 32u);
  EXPECT_NE(make_token(), make_token());
}

}  // namespace
}  // namespace vernier::apps
