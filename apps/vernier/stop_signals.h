// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>

namespace vernier::apps {

/// From here on SIGINT, SIGTERM and SIGHUP remove half-written files before they end the process, and writing
/// past a limit on the size of files is an error instead of its end. A signal that is ignored stays so.
void install_cleanup_signals();

/// While it lives, `handle` is called for a signal. A signal that was ignored at the start (as in background
/// jobs of a shell script) stays ignored.
class SignalHandler {
 public:
  SignalHandler(int signal, void (*handle)(int));
  ~SignalHandler();
  SignalHandler(const SignalHandler&) = delete;
  SignalHandler& operator=(const SignalHandler&) = delete;

 private:
  int signal_;
  struct sigaction old_ {};
};

/// While it lives, the first SIGINT or SIGTERM only raises a flag; a second one ends the process at once,
/// half-written files removed.
class StopSignals {
 public:
  StopSignals();
  const std::atomic<bool>& stop() const;

 private:
  SignalHandler interrupt_, terminate_;
};

/// While it lives, SIGUSR1 and SIGHUP, which comes when a terminal goes away, ask for the picture so far to
/// be written, and end nothing.
class WriteSignals {
 public:
  WriteSignals();
  /// For RenderSession::on_preview().
  std::atomic<bool>& now() const;

 private:
  SignalHandler hang_up_, user_;
};

}  // namespace vernier::apps
