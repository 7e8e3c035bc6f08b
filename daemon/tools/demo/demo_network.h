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

/// Returns true if a message sent on `url` comes back within a second.
bool lcm_round_trip(const std::string& url);

/// Moves this single-threaded process into a private user and network namespace with a multicast
/// route on the loopback. Returns false and sets the error if the kernel refuses.
bool enter_private_network(std::string& error);

}  // namespace framewatch::daemon
