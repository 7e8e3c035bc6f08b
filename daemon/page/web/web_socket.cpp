// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <random>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/log.h"

namespace framewatch::daemon {
namespace {

constexpr int kNotAccepted = 1024;
// Linux doubles the value for its own bookkeeping.
constexpr int kSend_bytes = 128 * 1024, kReceive_bytes = 32 * 1024;

PeerAddress peer_of_ipv4(const in_addr& address) {
  char text[INET_ADDRSTRLEN] = "";
  ::inet_ntop(AF_INET, &address, text, sizeof text);
  return {text, ntohl(address.s_addr) >> 24 == IN_LOOPBACKNET};
}

PeerAddress peer_of_ipv6(in6_addr address) {
  if (IN6_IS_ADDR_V4MAPPED(&address)) {
    in_addr v4{};
    std::memcpy(&v4, address.s6_addr + 12, sizeof v4);
    return peer_of_ipv4(v4);
  }
  if (IN6_IS_ADDR_LOOPBACK(&address)) return {"::1", true};
  std::memset(address.s6_addr + 8, 0, 8);
  char text[INET6_ADDRSTRLEN] = "";
  ::inet_ntop(AF_INET6, &address, text, sizeof text);
  return {std::string(text) + "/64", false};
}

constexpr std::string_view kTooLate =
    "HTTP/1.1 408 Request Timeout\r\nConnection: close\r\nContent-Length: 0\r\n\r\n";
constexpr std::int64_t kLineEvery_us = 60 * kSecond_us;

/// Shuts the socket down. The web server then sees its end and closes it.
void end_socket(int socket, WebConnections::Why why) {
  if (why == WebConnections::Why::late_request) {
    (void)::send(socket, kTooLate.data(), kTooLate.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  } else {
    // Data that waits in the kernel is dropped.
    const linger none{1, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_LINGER, &none, sizeof none);
  }
  ::shutdown(socket, SHUT_RDWR);
}

}  // namespace

PeerAddress peer_of(int socket) {
  sockaddr_storage from{};
  socklen_t size = sizeof from;
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&from), &size) != 0) return {};
  if (from.ss_family == AF_INET6)
    return peer_of_ipv6(reinterpret_cast<const sockaddr_in6*>(&from)->sin6_addr);
  return peer_of_ipv4(reinterpret_cast<const sockaddr_in*>(&from)->sin_addr);
}

bool allow_descriptors(int count, std::string& error) {
  rlimit limit{};
  const auto wanted = static_cast<rlim_t>(count);
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= wanted) return true;
  if (limit.rlim_max < wanted) {
    error = fmt::format(
        "--viewers needs {} open files, but this process may open only {}: raise ulimit -n (under "
        "systemd LimitNOFILE)",
        count, limit.rlim_max);
    return false;
  }
  limit.rlim_cur = wanted;
  if (::setrlimit(RLIMIT_NOFILE, &limit) == 0) return true;
  error = fmt::format("{} files at once: {}", count, std::strerror(errno));
  return false;
}

int listen_on(const std::string& address, int port, std::string& error) {
  sockaddr_in v4{};
  sockaddr_in6 v6{};
  v4.sin_family = AF_INET;
  v6.sin6_family = AF_INET6;
  v4.sin_port = v6.sin6_port = htons(static_cast<std::uint16_t>(port));
  const bool six = address.find(':') != std::string::npos;
  void* to = six ? static_cast<void*>(&v6.sin6_addr) : static_cast<void*>(&v4.sin_addr);
  if (::inet_pton(six ? AF_INET6 : AF_INET, address.c_str(), to) != 1) {
    error = address + ": is not an IP address";
    return -1;
  }
  const int socket = ::socket(six ? AF_INET6 : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int on = 1;
  const sockaddr* at =
      six ? reinterpret_cast<const sockaddr*>(&v6) : reinterpret_cast<const sockaddr*>(&v4);
  if (socket >= 0 && ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) == 0 &&
      ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSend_bytes, sizeof kSend_bytes) == 0 &&
      ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &kReceive_bytes, sizeof kReceive_bytes) == 0 &&
      ::bind(socket, at, six ? sizeof v6 : sizeof v4) == 0 && ::listen(socket, kNotAccepted) == 0)
    return socket;
  error = fmt::format("{} port {}: {}", address, port, std::strerror(errno));
  if (socket >= 0) ::close(socket);
  return -1;
}

std::string page_address(const WebSettings& settings, int port, const std::string& token) {
  const bool six = settings.address.find(':') != std::string::npos;
  return fmt::format("http://{}{}{}:{}/{}", six ? "[" : "", settings.address, six ? "]" : "", port,
                     token.empty() ? "" : "?token=" + token);
}

std::string random_token() {
  std::random_device source;
  std::string out;
  for (int i = 0; i < 4; ++i) out += fmt::format("{:08x}", source());
  return out;
}

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
  if (late + crowded > 0) line += "; the last one came from " + last_address_;
  log(LogLevel::warning, line);
}

PageUse ConnectionGuard::use() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return connections_.use();
}

}  // namespace framewatch::daemon
