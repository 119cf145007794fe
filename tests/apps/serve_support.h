// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vernier::test {

/// A connection to a port of this machine. Reading gives up after half a minute, which fails a test.
class Connection {
 public:
  explicit Connection(int port);
  ~Connection();
  Connection(Connection&& other) noexcept;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(const std::string& bytes) const;
  /// Reads until `text` has come, or to the end where it is empty, and returns all that has come and was not
  /// returned before.
  std::string read_until(const std::string& text = "");

 private:
  int socket_;
  std::string unread_;
};

struct HttpResponse {
  int status = 0;  ///< 0: there was no answer
  std::string headers, body;

  /// Empty when there is no such header.
  std::string header(const std::string& name) const;
  nlohmann::json json() const { return nlohmann::json::parse(body); }
};

/// `vernier serve` of this build, on a free port, ended when this is destroyed.
class RunningServer {
 public:
  /// Waits until it says where it serves.
  explicit RunningServer(std::vector<std::string> arguments);
  ~RunningServer();
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  int port() const { return port_; }
  /// As printed.
  const std::string& address() const { return address_; }

  /// Sends these bytes and reads the answer to its end.
  HttpResponse exchange(const std::string& bytes) const;
  HttpResponse get(const std::string& target, const std::string& headers = "") const;
  HttpResponse post(const std::string& target, const std::string& body,
                    const std::string& headers = "Content-Type: application/json\r\n") const;

  /// Seconds of processor time that the program has taken.
  double processor_seconds() const;
  /// Sends SIGTERM and returns the exit code.
  int end();

 private:
  pid_t process_ = -1;
  int output_ = -1;
  int port_ = 0;
  std::string address_;
};

/// A page's stream of events.
class EventStream {
 public:
  explicit EventStream(const RunningServer& server);

  /// 200: it was let in.
  int status() const { return status_; }
  /// The data of the next event of a kind for which `accept` is true.
  template <typename Accept>
  nlohmann::json next(const std::string& kind, const Accept& accept) {
    for (;;) {
      auto event = next(kind);
      if (accept(event)) return event;
    }
  }
  nlohmann::json next(const std::string& kind);

 private:
  Connection connection_;
  int status_ = 0;
};

}  // namespace vernier::test
