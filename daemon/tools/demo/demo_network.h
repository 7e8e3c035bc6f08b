// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

/// Transport of the demo's messages, and the reason for it.
struct DemoNetwork {
  std::string url;          ///< for LCM
  bool in_process = false;  ///< memq: all parts must share one LCM instance
  std::string explanation;  ///< one sentence for the user
};

/// Chooses UDP multicast on this machine (ttl 0), else the same in a private network namespace,
/// else memq. Call it before starting threads: it may move the process into that namespace.
DemoNetwork open_demo_network(int port);

}  // namespace framewatch::daemon
