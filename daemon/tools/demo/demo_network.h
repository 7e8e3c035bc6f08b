#pragma once

#include <string>

namespace framewatch::daemon {

/// How the demo's messages travel, and why.
struct DemoNetwork {
  std::string url;          ///< for LCM
  bool in_process = false;  ///< memq: everybody must share one LCM instance
  std::string explanation;  ///< one sentence for the person
};

/// UDP multicast that stays on this machine (ttl 0) when it works here; else in a network namespace
/// of this process' own; else memq. Call before any thread runs: it may move the process into that
/// namespace.
DemoNetwork open_demo_network(int port);

/// Returns true if a message sent on `url` comes back within a second.
bool lcm_round_trip(const std::string& url);

/// Moves this single-threaded process into its own user and network namespace with a multicast
/// route on the loopback. False, and the error in words, when the kernel refuses.
bool enter_private_network(std::string& error);

}  // namespace framewatch::daemon
