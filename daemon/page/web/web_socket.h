#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>

#include "daemon/page/metrics/metrics.h"
#include "daemon/page/web/web_admission.h"
#include "daemon/page/web/web_connections.h"

namespace framewatch::daemon {

/// A socket that listens on the address; -1, with the reason, when that fails. The kernel holds at
/// most 256 KiB to be sent and 64 KiB received of a connection.
int listen_on(const std::string& address, int port, std::string& error);

/// Where a connected socket leads.
PeerAddress peer_of(int socket);

/// Lets the process have so many files open. False, with the reason, when the machine forbids it.
[[nodiscard]] bool allow_descriptors(int count, std::string& error);

/// "http://127.0.0.1:8080/", with ?token= unless `token` is empty.
std::string page_address(const WebSettings& settings, int port, const std::string& token);

/// 32 hexadecimal digits from the operating system's random numbers.
std::string random_token();

/// Ends the connections of the page that must end (WebConnections), and says so: one log line a
/// minute. A socket may be given here between its opening and closed(); then any thread may call.
class ConnectionGuard {
 public:
  explicit ConnectionGuard(const ConnectionLimits& limits) : connections_(limits) {}

  void opened(int socket);
  /// The request has come whole.
  void asked(int socket);
  /// An answer of so many bytes is held for it.
  void answered(int socket, std::size_t bytes);
  /// It becomes a viewer of the stream of events. False when there is no place.
  [[nodiscard]] bool watches(int socket);
  /// The socket is about to be closed.
  void closed(int socket);
  /// Ends what is overdue; to be called at least once a second.
  void sweep();

  PageUse use() const;

 private:
  void end(const std::vector<WebConnections::Ending>& endings);
  void report(std::int64_t now_us);

  mutable std::mutex mutex_;  ///< guards what is below
  WebConnections connections_;
  std::string last_address_;
  PageUse told_;  ///< its counters, when the last line was logged
  std::int64_t next_line_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
