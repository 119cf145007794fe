// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/http_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "apps/serve/guard.h"
#include "apps/serve/routes.h"
#include "apps/serve/workers.h"
#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr size_t threads_for_requests = 8;  // beside those that pages' streams of events take
constexpr size_t most_request_bytes = 4096;
constexpr time_t seconds_to_send = 5, seconds_to_read = 3;
constexpr unsigned dead_after_milliseconds = 20000;

/// cpp-httplib's own options let several programs share a port, which would hide that it is taken.
void set_socket_options(socket_t socket) {
  const int on = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  // Accepted connections inherit it: of those whose other end has gone away, or does not read.
  setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &dead_after_milliseconds, sizeof dead_after_milliseconds);
}

/// As it stands in addresses.
std::string name_in_address(const std::string& host) {
  if (host == "0.0.0.0" || host == "::") {
    std::array<char, 256> name{};
    if (gethostname(name.data(), name.size() - 1) == 0) return name.data();
  }
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

RequestHead head_of(const httplib::Request& request) {
  return {request.remote_addr,
          request.method,
          request.path,
          request.get_header_value("Host"),
          request.get_header_value("Origin"),
          request.get_header_value("Content-Type"),
          request.get_header_value("Cookie"),
          request.get_param_value("token")};
}

}  // namespace

class HttpServer::State {
 public:
  State(const std::string& host, int port) : host_(host), token_(is_loopback(host) ? "" : make_token()) {
    server.new_task_queue = [] { return new Workers(most_pages + threads_for_requests); };
    server.set_socket_options(set_socket_options);
    server.set_tcp_nodelay(true);
    server.set_payload_max_length(most_request_bytes);
    server.set_read_timeout(seconds_to_read);
    server.set_write_timeout(seconds_to_send);
    server.set_keep_alive_max_count(1);  // so that none who is idle takes a thread
    errno = 0;
    port_ = port == 0 ? server.bind_to_any_port(host) : server.bind_to_port(host, port) ? port : -1;
    if (port_ < 0)
      throw Error(ErrorKind::input,
                  fmt::format("cannot listen on {}, port {}: {}; --host and --port 0, any "
                              "free one, choose another",
                              host, port, errno ? std::strerror(errno) : "no such address"));
    guard.emplace(token_, port_);
  }

  std::string address() const {
    const std::string place = fmt::format("http://{}:{}/", name_in_address(host_), port_);
    return token_.empty() ? place : place + "?token=" + token_;
  }

  httplib::Server server;
  std::optional<Guard> guard;
  std::atomic<bool> is_stopped{false};

 private:
  const std::string host_, token_;
  int port_ = -1;
};

HttpServer::HttpServer(const std::string& host, int port) : state_(std::make_unique<State>(host, port)) {}
HttpServer::~HttpServer() = default;

std::string HttpServer::address() const { return state_->address(); }

void HttpServer::serve(Served served) {
  using Outcome = httplib::Server::HandlerResponse;
  httplib::Server& server = state_->server;
  server.set_pre_routing_handler([&](const httplib::Request& request, httplib::Response& response) {
    const RequestHead head = head_of(request);
    if (const auto refusal = state_->guard->refusal(head)) {
      refuse(response, refusal->status, refusal->reason);
      return Outcome::Handled;
    }
    if (!state_->guard->brings_token(head)) return Outcome::Unhandled;
    response.set_header("Set-Cookie", state_->guard->cookie());
    response.set_redirect("/", 303);
    return Outcome::Handled;
  });
  add_routes(server, std::move(served));
  if (!server.listen_after_bind())
    throw Error(ErrorKind::input, fmt::format("no longer listens: {}", std::strerror(errno)));
}

void HttpServer::stop() {
  httplib::Server& server = state_->server;
  if (server.is_running() && !state_->is_stopped.exchange(true)) server.stop();
}

}  // namespace vernier::apps
