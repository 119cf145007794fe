// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <csignal>

namespace vernier::apps {

/// From here on SIGINT, SIGTERM and SIGHUP remove half-written files before they end the process, and writing
/// past a limit on the size of files is an error instead of its end. A signal that is ignored stays so.
void install_cleanup_signals();

/// While it lives, the first SIGINT or SIGTERM only raises a flag; a second one ends the process at
/// once, half-written files removed. A signal that was ignored at the start (as in background jobs of a shell
/// script) stays ignored.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  const std::atomic<bool>& stop() const;

 private:
  struct sigaction old_interrupt_ {};
  struct sigaction old_terminate_ {};
};

}  // namespace vernier::apps
