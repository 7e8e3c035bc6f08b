// SPDX-License-Identifier: MIT
#include "daemon/base/signals.h"

#include <atomic>
#include <csignal>

namespace framewatch::daemon {
namespace {

volatile std::sig_atomic_t reload_signalled = 0;

extern "C" void request_reload(int) {
  reload_signalled = 1;
}

std::atomic<int> stop_signalled{0};  // a StopLimit reads it in another thread
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void request_stop(int) {
  stop_signalled = 1;
}

}  // namespace

void catch_reload_signal() {
  struct sigaction action {};
  action.sa_handler = request_reload;
  ::sigaction(SIGHUP, &action, nullptr);
}

bool reload_requested() {
  if (reload_signalled == 0) return false;
  reload_signalled = 0;
  return true;
}

void catch_stop_signals() {
  std::signal(SIGCHLD, SIG_DFL);  // waitpid() gets no exit status while SIGCHLD is ignored
  struct sigaction action {};
  action.sa_handler = request_stop;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

bool stop_requested() {
  return stop_signalled != 0;
}

}  // namespace framewatch::daemon
