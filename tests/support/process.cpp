// SPDX-License-Identifier: Apache-2.0
#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <sstream>
#include <stdexcept>

namespace vernier::test {
namespace {

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  Pipe() {
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  }
  ~Pipe() {
    for (const int end : ends)
      if (end >= 0) close(end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void close_end(int which) {
    close(ends[which]);
    ends[which] = -1;
  }
};

[[noreturn]] void become(const std::vector<char*>& arguments, const Pipe& out, const Pipe& err) {
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out.ends[1], STDOUT_FILENO);
  dup2(err.ends[1], STDERR_FILENO);
  // A test run in the background, of a script or by nohup, starts with these ignored.
  std::signal(SIGHUP, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  execv(arguments[0], arguments.data());
  _exit(127);
}

/// Appends what can be read; false at the end of the stream.
bool read_some(int from, std::string& to) {
  std::array<char, 4096> buffer;
  const ssize_t count = read(from, buffer.data(), buffer.size());
  if (count > 0) to.append(buffer.data(), static_cast<size_t>(count));
  return count > 0;
}

void collect(pid_t child, Pipe& out, Pipe& err, const SendSignal& signal, ProcessResult& result) {
  int sent = 0;
  std::array<pollfd, 2> streams{{{out.ends[0], POLLIN, 0}, {err.ends[0], POLLIN, 0}}};
  while (streams[0].fd >= 0 || streams[1].fd >= 0) {
    if (poll(streams.data(), streams.size(), -1) < 0) throw std::runtime_error("poll failed");
    if (streams[0].revents && !read_some(out.ends[0], result.out)) streams[0].fd = -1;
    if (streams[1].revents && !read_some(err.ends[0], result.err)) streams[1].fd = -1;
    const bool ready = signal.signal != 0 && result.err.find(signal.when_error_has) != std::string::npos;
    for (; ready && sent < signal.times; ++sent) kill(child, signal.signal);
  }
}

}  // namespace

std::vector<std::string> ProcessResult::err_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

ProcessResult run_process(const std::vector<std::string>& arguments, const SendSignal& signal) {
  std::vector<std::string> words = arguments;
  std::vector<char*> raw;
  raw.reserve(words.size() + 1);
  for (auto& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  Pipe out, err;
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) become(raw, out, err);
  out.close_end(1);
  err.close_end(1);
  ProcessResult result;
  collect(child, out, err, signal, result);
  int status = 0;
  waitpid(child, &status, 0);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

ProcessResult run_vernier(std::vector<std::string> arguments, const SendSignal& signal) {
  arguments.emplace(arguments.begin(), VERNIER_BINARY);
  return run_process(arguments, signal);
}

}  // namespace vernier::test
