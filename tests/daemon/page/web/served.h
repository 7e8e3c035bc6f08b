// SPDX-License-Identifier: MIT
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/page/view/live_view.h"
#include "daemon/page/web/web_server.h"
#include "daemon/page/web/web_socket.h"
#include "drivers/files/encoded.h"
#include "tests/support/config_fixture.h"
#include "tests/support/history_fixture.h"

namespace framewatch::test {

/// Returns the answer of a server on this machine: all of it or, if `last` is given, up to that
/// text.
inline std::string ask(int port, const std::string& request, const std::string& last = {}) {
  const int s = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  std::string out;
  timeval wait{30, 0};
  ::setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  if (::connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
      ::send(s, request.data(), request.size(), MSG_NOSIGNAL) > 0) {
    char part[4096];
    const auto all = [&] { return !last.empty() && out.find(last) != std::string::npos; };
    for (ssize_t got; !all() && (got = ::recv(s, part, sizeof part, 0)) > 0;)
      out.append(part, static_cast<std::size_t>(got));
  }
  ::close(s);
  return out;
}

inline std::string request(const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more + "\r\n";
}

/// A page on a free port that gets messages directly. published_ has its published messages,
/// given() its commands. Daemons answer commands with problem_.
class Served : public ::testing::Test {
 protected:
  Served() : Served(settings()) {}
  explicit Served(const daemon::WebSettings& settings, const std::string& config = kGoodConfig)
      : config_(good(config)),
        view_(
            config_,
            [this](std::int64_t, const std::string& channel,
                   const std::vector<std::uint8_t>& bytes) { published_[channel] = bytes; },
            [this](const std::string& service, const daemon::CommandPacket& command) {
              const std::lock_guard<std::mutex> lock(mutex_);
              given_[service + " " + command.channel] = command.bytes;
              return daemon::CommandAnswer{problem_.empty(), problem_, {}};
            }),
        server_(settings, view_) {
    std::string error;
    const int socket = daemon::listen_on("127.0.0.1", 0, error);
    EXPECT_GE(socket, 0) << error;
    EXPECT_TRUE(server_.start(socket, error)) << error;
  }
  static daemon::WebSettings settings() {
    daemon::WebSettings s;
    s.metrics = [](const daemon::PageUse& use) {
      return "viewers " + std::to_string(use.viewers) + "\n";
    };
    s.token = "0123456789abcdef";
    return s;
  }
  template <typename Message>
  void send(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = drivers::encoded(message);
    view_.message(channel, bytes.data(), bytes.size());
  }

  /// Waits for and returns the newest command with this service and channel; empty without one.
  std::vector<std::uint8_t> given(const std::string& which) {
    std::vector<std::uint8_t> out;
    comes_true(
        [&] {
          const std::lock_guard<std::mutex> lock(mutex_);
          out = given_[which];
          return !out.empty();
        },
        std::chrono::seconds(30));
    return out;
  }

  daemon::Config config_;
  std::mutex mutex_;
  std::map<std::string, std::vector<std::uint8_t>> given_;
  std::string problem_;
  std::map<std::string, std::vector<std::uint8_t>> published_;
  daemon::LiveView view_;
  daemon::WebServer server_;
};

}  // namespace framewatch::test
