#include "daemon/page/web/connection_guard.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"
#include "daemon/page/web/web_socket.h"

namespace framewatch::daemon {
namespace {

constexpr std::string_view kTooLate =
    "HTTP/1.1 408 Request Timeout\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
constexpr std::int64_t kLineEvery_us = 60 * kSecond_us;

/// Whoever serves the socket sees its end and closes it.
void end_socket(int socket, WebConnections::Why why) {
  if (why == WebConnections::Why::late_request) {
    (void)::send(socket, kTooLate.data(), kTooLate.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  } else {
    // What waits in the kernel to be sent goes with it.
    const linger none{1, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }
  ::shutdown(socket, SHUT_RDWR);
}

}  // namespace

void ConnectionGuard::end(const std::vector<WebConnections::Ending>& endings) {
  for (const WebConnections::Ending& e : endings) {
    end_socket(e.connection, e.why);
    last_address_ = e.address;
  }
}

void ConnectionGuard::opened(int socket) {
  const std::lock_guard<std::mutex> lock(mutex_);
  end(connections_.opened(socket, peer_of(socket), steady_clock_us()));
}

void ConnectionGuard::asked(int socket) {
  const std::lock_guard<std::mutex> lock(mutex_);
  end(connections_.asked(socket, steady_clock_us()));
}

void ConnectionGuard::answered(int socket, std::size_t bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  end(connections_.answered(socket, bytes));
}

bool ConnectionGuard::watches(int socket) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connections_.watches(socket);
}

void ConnectionGuard::closed(int socket) {
  const std::lock_guard<std::mutex> lock(mutex_);
  connections_.closed(socket);
}

void ConnectionGuard::sweep() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t now_us = steady_clock_us();
  end(connections_.overdue(now_us));
  report(now_us);
}

void ConnectionGuard::report(std::int64_t now_us) {
  if (now_us < next_line_us_) return;
  const PageUse use = connections_.use();
  const auto late = use.late_requests + use.late_answers - told_.late_requests - told_.late_answers;
  const auto crowded = use.crowded_out - told_.crowded_out;
  const auto refused = use.viewers_refused - told_.viewers_refused;
  if (late + crowded + refused == 0) return;
  next_line_us_ = now_us + kLineEvery_us;
  told_ = use;
  std::string line = fmt::format(
      "the page ended {} connections that were too slow and {} for newer ones, and refused {} "
      "viewers",
      late, crowded, refused);
  if (late + crowded > 0) line += "; the last was of " + last_address_;
  log(LogLevel::warning, line);
}

PageUse ConnectionGuard::use() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connections_.use();
}

}  // namespace framewatch::daemon
