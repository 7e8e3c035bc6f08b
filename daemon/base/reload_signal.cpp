#include "daemon/base/reload_signal.h"

#include <csignal>

namespace framewatch::daemon {
namespace {

volatile std::sig_atomic_t reload_signalled = 0;

extern "C" void request_reload(int) {
  reload_signalled = 1;
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

}  // namespace framewatch::daemon
