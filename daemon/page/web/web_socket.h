// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "daemon/page/metrics/metrics.h"
#include "daemon/page/web/web_admission.h"
#include "daemon/page/web/web_connections.h"

namespace framewatch::daemon {

/// Returns a socket that listens on the address. Returns -1 and sets `error` on failure. The kernel
/// buffers at most 256 KiB to send and 64 KiB received for each connection.
int listen_on(const std::string& address, int port, std::string& error);

/// Returns the address at the other end of a connected socket.
PeerAddress peer_of(int socket);

/// Allows the process to open `count` files. Returns false and sets `error` when the machine
/// forbids it.
[[nodiscard]] bool allow_descriptors(int count, std::string& error);

/// Returns "http://127.0.0.1:8080/", with ?token= unless `token` is empty.
std::string page_address(const WebSettings& settings, int port, const std::string& token);

/// Returns 32 random hexadecimal digits from the operating system.
std::string random_token();

/// Ends the connections that WebConnections selects and logs at most one line a minute. Any thread
/// may call it with a socket that is open, until closed().
class ConnectionGuard {
 public:
  explicit ConnectionGuard(const ConnectionLimits& limits) : connections_(limits) {}

  // As in WebConnections.
  void opened(int socket);
  void asked(int socket);
  void answered(int socket, std::size_t bytes);
  [[nodiscard]] bool watches(int socket);
  /// The socket is about to be closed.
  void closed(int socket);
  /// Ends overdue connections. Call it at least once a second.
  void sweep();

  PageUse use() const;

 private:
  void end(const std::vector<WebConnections::Ending>& endings);
  void report(std::int64_t now_us);

  mutable std::mutex mutex_;  ///< guards the members below
  WebConnections connections_;
  std::string last_address_;
  PageUse told_;  ///< counters at the last log line
  std::int64_t next_line_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
