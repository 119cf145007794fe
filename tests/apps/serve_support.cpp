// SPDX-License-Identifier: Apache-2.0
#include "tests/apps/serve_support.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace vernier::test {
namespace {

int status_of(const std::string& response) {
  return response.starts_with("HTTP/1.1 ") ? std::stoi(response.substr(9)) : 0;
}

[[noreturn]] void become_server(std::vector<std::string> words, int output) {
  std::vector<char*> raw;
  raw.reserve(words.size() + 1);
  for (auto& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  dup2(output, STDOUT_FILENO);
  dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
  std::signal(SIGTERM, SIG_DFL);  // a test run in the background of a script starts with it ignored
  execv(raw[0], raw.data());
  _exit(127);
}

}  // namespace

Connection::Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const timeval limit{30, 0};
  setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(uint16_t(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    throw std::runtime_error("cannot connect");
}

Connection::~Connection() {
  if (socket_ >= 0) close(socket_);
}

Connection::Connection(Connection&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), unread_(std::move(other.unread_)) {}

void Connection::send(const std::string& bytes) const {
  for (size_t at = 0; at < bytes.size();) {
    const ssize_t count = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
    if (count <= 0) return;  // a server that refuses a request need not read all of it
    at += size_t(count);
  }
}

std::string Connection::read_until(const std::string& text) {
  std::array<char, 65536> buffer;
  for (;;) {
    if (const size_t found = unread_.find(text); !text.empty() && found != std::string::npos) {
      std::string read = unread_.substr(0, found + text.size());
      unread_.erase(0, read.size());
      return read;
    }
    const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
    if (count < 0 && errno == EAGAIN) throw std::runtime_error("the server is silent");
    if (count <= 0) break;
    unread_.append(buffer.data(), size_t(count));
  }
  if (!text.empty()) throw std::runtime_error("the server ended the connection before it sent " + text);
  return std::exchange(unread_, {});
}

std::string HttpResponse::header(const std::string& name) const {
  const std::string start = "\r\n" + name + ": ";
  const size_t at = headers.find(start);
  if (at == std::string::npos) return {};
  return headers.substr(at + start.size(), headers.find("\r\n", at + 2) - at - start.size());
}

RunningServer::RunningServer(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {VERNIER_PROGRAM, "serve", "--port", "0", "--threads", "2"});
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  process_ = fork();
  if (process_ == 0) become_server(std::move(arguments), ends[1]);
  close(ends[1]);
  output_ = ends[0];
  std::string line;
  for (char c = 0; c != '\n' && read(output_, &c, 1) == 1;) line += c;
  const size_t place = line.find("http://");
  if (place == std::string::npos) throw std::runtime_error("vernier serve does not start");
  address_ = line.substr(place, line.size() - place - 1);
  port_ = std::stoi(address_.substr(address_.find(':', 7) + 1));
}

RunningServer::~RunningServer() {
  end();
  close(output_);
}

int RunningServer::end() {
  if (process_ < 0) return 0;
  kill(process_, SIGTERM);
  int status = 0;
  waitpid(std::exchange(process_, -1), &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

HttpResponse RunningServer::exchange(const std::string& bytes) const {
  Connection connection(port_);
  connection.send(bytes);
  const std::string all = connection.read_until();
  const size_t split = std::min(all.find("\r\n\r\n"), all.size());
  return {status_of(all), all.substr(0, split + 2), split == all.size() ? "" : all.substr(split + 4)};
}

HttpResponse RunningServer::get(const std::string& target, const std::string& headers) const {
  const std::string host =
      headers.find("Host:") == std::string::npos ? "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n" : "";
  return exchange("GET " + target + " HTTP/1.1\r\n" + host + headers + "\r\n");
}

HttpResponse RunningServer::post(const std::string& target, const std::string& body,
                                 const std::string& headers) const {
  return exchange("POST " + target + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port_) + "\r\n" +
                  headers + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
}

/// From proc(5): user and system time, in ticks, are the 14th and 15th fields.
double RunningServer::processor_seconds() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / double(sysconf(_SC_CLK_TCK));
}

EventStream::EventStream(const RunningServer& server) : connection_(server.port()) {
  connection_.send("GET /events HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server.port()) + "\r\n\r\n");
  status_ = status_of(connection_.read_until("\r\n\r\n"));
}

nlohmann::json EventStream::next(const std::string& kind) {
  const std::string start = "event: " + kind + "\ndata: ";
  connection_.read_until(start);
  return nlohmann::json::parse(connection_.read_until("\n\n"));
}

}  // namespace vernier::test
