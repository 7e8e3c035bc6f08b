#include "daemon/base/reload_signal.h"

#include <csignal>

namespace framewatch::daemon {
namespace {

volatile std::sig_atomic_t requested = 0;

extern "C" void request_reload(int) {
  requested = 1;
}

}  // namespace

void catch_reload_signal() {
  struct sigaction action {};
  action.sa_handler = request_reload;
  ::sigaction(SIGHUP, &action, nullptr);
}

bool reload_requested() {
  if (requested == 0) return false;
  requested = 0;
  return true;
}

}  // namespace framewatch::daemon
