// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace vernier::apps {

/// What of a request tells whether it may be answered. Empty texts: it has none of that.
struct RequestHead {
  std::string remote;  ///< address it came from
  std::string method, path, host, origin, content_type, cookie, token;
};

struct Refusal {
  int status;  ///< of HTTP
  std::string reason;
};

/// Requests that an address may send: a few hundred a second, some more at once.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;

  /// Whether one more is allowed now; it then counts.
  bool allows(const std::string& address, Clock::time_point now);

 private:
  static constexpr double per_second = 300, at_once = 600;
  static constexpr size_t most_addresses = 1024;  ///< those remembered

  struct Allowance {
    double left = at_once;
    Clock::time_point at;
  };
  std::mutex mutex_;
  std::map<std::string, Allowance> allowances_;
};

/// Who may talk to the server. On the loopback interface that is every program of this machine, but no web
/// page of another site that the same browser shows: those come with another origin, or, by a name that is
/// made to stand for this machine, with another host. Elsewhere it is who has the token.
class Guard {
 public:
  /// `token` is empty where none is needed.
  Guard(std::string token, int port);

  /// None: it may be answered.
  std::optional<Refusal> refusal(const RequestHead& request);

  /// Whether the request brings the token in its address, which a cookie is to replace.
  bool brings_token(const RequestHead& request) const;
  /// The header that makes a browser keep the token.
  std::string cookie() const;

 private:
  bool is_own_host(const std::string& host) const;
  bool is_token(const std::string& text) const;
  std::string cookie_value(const std::string& cookies) const;

  const std::string token_, port_, cookie_name_;
  RateLimit rate_;
};

/// Whether only programs of this machine reach a server there.
bool is_loopback(const std::string& host);

/// 128 random bits that nobody can guess, as 32 hexadecimal digits. Throws Error.
std::string make_token();

}  // namespace vernier::apps
