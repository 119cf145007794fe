// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/guard.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>

#include "vernier/error.h"

namespace vernier::apps {
namespace {

/// "[::1]:8080" and "localhost:8080" without the port; none where it is another one.
std::optional<std::string> without_port(const std::string& host, const std::string& port) {
  const std::string end = ":" + port;
  if (host.size() > end.size() && host.ends_with(end)) return host.substr(0, host.size() - end.size());
  if (port == "80") return host;
  return std::nullopt;
}

}  // namespace

bool RateLimit::allows(const std::string& address, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (allowances_.size() >= most_addresses && !allowances_.contains(address)) {
    const auto oldest = std::min_element(allowances_.begin(), allowances_.end(),
                                         [](auto& a, auto& b) { return a.second.at < b.second.at; });
    allowances_.erase(oldest);
  }
  const auto [found, is_new] = allowances_.try_emplace(address, Allowance{at_once, now});
  Allowance& allowance = found->second;
  const std::chrono::duration<double> since = now - allowance.at;
  allowance.left = std::min(at_once, allowance.left + per_second * since.count());
  allowance.at = now;
  if (allowance.left < 1) return false;
  --allowance.left;
  return true;
}

Guard::Guard(std::string token, int port)
    : token_(std::move(token)), port_(std::to_string(port)), cookie_name_("vernier_" + port_) {}

bool Guard::is_own_host(const std::string& host) const {
  const auto name = without_port(host, port_);
  return name && (*name == "localhost" || *name == "[::1]" || is_loopback(*name));
}

/// Takes the same time wherever the texts differ.
bool Guard::is_token(const std::string& text) const {
  unsigned difference = text.size() != token_.size();
  for (size_t i = 0; i < token_.size(); ++i)
    difference |= unsigned(token_[i] ^ (i < text.size() ? text[i] : '\0'));
  return difference == 0;
}

std::string Guard::cookie_value(const std::string& cookies) const {
  const std::string start = cookie_name_ + "=";
  for (size_t at = 0; at < cookies.size();) {
    const size_t end = std::min(cookies.find(';', at), cookies.size());
    const std::string cookie = cookies.substr(at, end - at);
    if (cookie.starts_with(start)) return cookie.substr(start.size());
    at = cookies.find_first_not_of("; ", end);
  }
  return {};
}

bool Guard::brings_token(const RequestHead& request) const {
  return !token_.empty() && request.method == "GET" && request.path == "/" && is_token(request.token);
}

std::string Guard::cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_name_, token_);
}

std::optional<Refusal> Guard::refusal(const RequestHead& request) {
  if (!rate_.allows(request.remote, RateLimit::Clock::now()))
    return Refusal{429, "too many requests from this address; wait a moment"};
  if (token_.empty() && !is_own_host(request.host))
    return Refusal{403, "the address must be that of this machine, such as http://127.0.0.1:" + port_};
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return Refusal{403, "pages of other sites may not use this server"};
  if (!token_.empty() && !brings_token(request) && !is_token(cookie_value(request.cookie)))
    return Refusal{401, "open the address with the token that vernier serve printed when it started"};
  if (request.method == "POST" && !request.content_type.starts_with("application/json"))
    return Refusal{415, "expected Content-Type: application/json"};
  return std::nullopt;
}

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" ||
         (host.starts_with("127.") && host.find_first_not_of("0123456789.") == std::string::npos);
}

std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
    throw Error(ErrorKind::input, "the system gives no random bytes for a token");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace vernier::apps
