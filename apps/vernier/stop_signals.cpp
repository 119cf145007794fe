// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/stop_signals.h"

#include "core/base/atomic_file.h"

namespace vernier::apps {
namespace {

std::atomic<bool> stop_requested{false};
std::atomic<bool> write_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

/// Ends the process by the signal that it handles, as if it had not been handled.
void clean_up(int signal) {
  AtomicFile::remove_unfinished();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void request_stop(int signal) {
  if (stop_requested.exchange(true)) clean_up(signal);
}

void request_write(int) { write_requested = true; }

using Handle = void (*)(int);
/// What came before is not for whom `handle` is installed now.
Handle forgetting(std::atomic<bool>& requested, Handle handle) {
  requested = false;
  return handle;
}

void install(int signal, void (*handler)(int), struct sigaction& old) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, &old);
  if (old.sa_handler == SIG_IGN) sigaction(signal, &old, nullptr);
}

}  // namespace

void install_cleanup_signals() {
  struct sigaction old {};
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) install(signal, clean_up, old);
  std::signal(SIGXFSZ, SIG_IGN);
}

SignalHandler::SignalHandler(int signal, Handle handle) : signal_(signal) { install(signal, handle, old_); }

SignalHandler::~SignalHandler() { sigaction(signal_, &old_, nullptr); }

StopSignals::StopSignals()
    : interrupt_(SIGINT, forgetting(stop_requested, request_stop)), terminate_(SIGTERM, request_stop) {}

const std::atomic<bool>& StopSignals::stop() const { return stop_requested; }

WriteSignals::WriteSignals()
    : hang_up_(SIGHUP, forgetting(write_requested, request_write)), user_(SIGUSR1, request_write) {}

std::atomic<bool>& WriteSignals::now() const { return write_requested; }

}  // namespace vernier::apps
