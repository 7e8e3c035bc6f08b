// SPDX-License-Identifier: MIT
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/session_status_t.hpp>

#include "daemon/page/web/web_server.h"
#include "daemon/page/web/web_socket.h"
#include "tests/daemon/page/web/served.h"

namespace framewatch::daemon {
namespace slow_connections_test {

using test::ask, test::request, test::Served;
using Clock = std::chrono::steady_clock;

// Limits.
constexpr int kSlow = 2000, kViewers = 200, kAgainAtOnce = 50;
constexpr std::size_t kLongAnswer = 4 << 20;   // more than the kernel buffers
constexpr std::chrono::seconds kPatience{30};  // for actions that take milliseconds
constexpr std::chrono::milliseconds kTick{20};

constexpr std::chrono::seconds kAttack{4};

/// Paths and texts of their answers.
constexpr std::array<std::pair<const char*, const char*>, 5> kAsked{{{"/healthz", "ok"},
                                                                     {"/metrics", "viewers 200"},
                                                                     {"/", "</html>"},
                                                                     {"/page.js", "EventSource"},
                                                                     {"/building.json", "axes"}}};
constexpr const char* kHalfAHead = "GET / HTTP/1.1\r\nHost: localhost\r\nX: ";

int connect_to(int port, int how = 0) {
  const int s = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | how, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  const timeval wait{kPatience.count(), 0};
  ::setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  ::setsockopt(s, SOL_SOCKET, SO_SNDTIMEO, &wait, sizeof wait);
  if (::connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 || errno == EINPROGRESS)
    return s;
  ::close(s);
  return -1;
}

bool say(int socket, const std::string& text) {
  return ::send(socket, text.data(), text.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(text.size());
}

/// Returns the bytes up to the end of the connection or, if `last` is given, up to that text.
std::string rest(int socket, const std::string& last = {}) {
  std::string out;
  char part[4096];
  const auto all = [&] { return !last.empty() && out.find(last) != std::string::npos; };
  for (ssize_t got; !all() && (got = ::recv(socket, part, sizeof part, 0)) > 0;)
    out.append(part, static_cast<std::size_t>(got));
  return out;
}

template <typename Done>
bool comes_true(const Done& done) {
  for (const Clock::time_point since = Clock::now(); !done(); std::this_thread::sleep_for(kTick))
    if (Clock::now() > since + kPatience) return false;
  return true;
}

/// Returns a message with that text, which the page shows.
session_status_t refusal(const std::string& text) {
  session_status_t s{};
  s.refused = text;
  return s;
}

/// Repeats `work` in a thread.
class Meanwhile {
 public:
  template <typename Work>
  explicit Meanwhile(Work work)
      : thread_([this, work] {
          while (!over_) {
            work();
            std::this_thread::sleep_for(kTick);
          }
        }) {}
  ~Meanwhile() {
    over_ = true;
    thread_.join();
  }
  Meanwhile(const Meanwhile&) = delete;
  Meanwhile& operator=(const Meanwhile&) = delete;

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

/// Connections that send a byte now and then but never a whole request. Closed ones reconnect.
class SlowConnections {
 public:
  SlowConnections(int port, int count) : port_(port) {
    for (int i = 0; i < count; ++i) sockets_.push_back(begin());
  }
  ~SlowConnections() {
    for (const int s : sockets_)
      if (s >= 0) ::close(s);
  }
  SlowConnections(const SlowConnections&) = delete;
  SlowConnections& operator=(const SlowConnections&) = delete;

  void drip() {
    int again = 0;
    for (int& s : sockets_) {
      if (s >= 0 && (say(s, "b") || errno == EAGAIN)) continue;
      if (++again > kAgainAtOnce) continue;
      if (s >= 0) ::close(s);
      s = begin();
    }
  }

 private:
  int begin() const {
    const int s = connect_to(port_, SOCK_NONBLOCK);
    if (s >= 0) (void)say(s, kHalfAHead);
    return s;
  }

  int port_;
  std::vector<int> sockets_;
};

TEST_F(Served, AnswersAmongTwoThousandSlowConnections) {
  std::string error;
  ASSERT_TRUE(allow_descriptors(2 * kSlow + 2 * kViewers + 1000, error)) << error;
  const Meanwhile tended([this] { server_.wake(); });
  std::vector<int> viewers;
  for (int i = 0; i < kViewers; ++i) {
    viewers.push_back(connect_to(server_.port()));
    ASSERT_TRUE(say(viewers.back(), request("GET /events")));
  }
  ASSERT_TRUE(comes_true([this] { return server_.viewers() == kViewers; }));
  SlowConnections slow(server_.port(), kSlow);
  const Meanwhile dripping([&slow] { slow.drip(); });
  double longest_s = 0;
  const Clock::time_point since = Clock::now();
  for (int i = 0; i < 5 || Clock::now() < since + kAttack; ++i) {
    const auto [path, content] = kAsked[static_cast<std::size_t>(i) % kAsked.size()];
    const Clock::time_point asked = Clock::now();
    const std::string answer = ask(server_.port(), request(std::string("GET ") + path));
    const std::chrono::duration<double> took = Clock::now() - asked;
    longest_s = std::max(longest_s, took.count());
    ASSERT_NE(answer.find("200 OK"), std::string::npos) << path << ": " << answer.substr(0, 100);
    ASSERT_NE(answer.find(content), std::string::npos) << path;
    ASSERT_LT(took, kPatience) << path;
    std::this_thread::sleep_for(kTick);
  }
  RecordProperty("longest_ms", static_cast<int>(1e3 * longest_s));
  EXPECT_EQ(server_.viewers(), kViewers);
  // Viewers stay connected: each one receives new data.
  send("FRAMEWATCH_SESSION", refusal("late"));
  for (const int s : viewers) {
    EXPECT_NE(rest(s, "late").find("late"), std::string::npos);
    ::close(s);
  }
}

/// No answer may be delayed by more than a second, and the metrics are long.
class HastyPage : public Served {
 protected:
  static WebSettings settings() {
    WebSettings out = Served::settings();
    ConnectionLimits& limits = out.connections;
    limits.request_us = limits.answer_us = kSecond_us;
    limits.idle_s = 2;
    limits.answer_bytes = 4 * kLongAnswer;
    out.metrics = [](const PageUse&) { return std::string(kLongAnswer, '#') + "\n"; };
    return out;
  }
  HastyPage() : Served(settings()) {}

  const Meanwhile tended_{[this] { server_.wake(); }};
};

TEST_F(HastyPage, ClosesASlowRequest) {
  const std::string tls("\x16\x03\x01\0\xc8\x01\0\0\xc4\x03\x03", 11), zeros(1000, '\0');
  for (const std::string& begun :
       {std::string(), std::string("G"), std::string("\r\n\r\n\r\n"), std::string(kHalfAHead), tls,
        zeros, std::string("GET / HTTP/1.1\r\n\r"),
        std::string("POST /baseline HTTP/1.1\r\nContent-Length: 5\r\n")}) {
    const int s = connect_to(server_.port());
    ASSERT_GE(s, 0);
    ASSERT_TRUE(say(s, begun));
    const Clock::time_point since = Clock::now();
    bool open = true;
    while (open && Clock::now() < since + kPatience) {
      open = say(s, begun.starts_with('\r') ? "\r\n" : "b");
      std::this_thread::sleep_for(kTick);
    }
    EXPECT_FALSE(open) << begun;
    ::close(s);
  }
  const int s = connect_to(server_.port());
  ASSERT_TRUE(say(s, kHalfAHead));
  EXPECT_TRUE(rest(s).starts_with("HTTP/1.1 408 ")) << "listeners get the events";
  ::close(s);
}

TEST_F(HastyPage, ClosesAViewerThatNeverReadsWithoutDisturbingOthers) {
  const int never = connect_to(server_.port()), reads = connect_to(server_.port());
  for (const int s : {never, reads}) ASSERT_TRUE(say(s, request("GET /events")));
  const std::string large(100'000, 'x');
  std::atomic<std::size_t> read = 0;
  const Meanwhile events([&] { send("FRAMEWATCH_SESSION", refusal(large)); });
  const Meanwhile reader([&] {
    char part[65536];
    for (ssize_t got; (got = ::recv(reads, part, sizeof part, MSG_DONTWAIT)) > 0;)
      read += static_cast<std::size_t>(got);
  });
  EXPECT_TRUE(comes_true([&] { return server_.viewers() == 2; }));
  EXPECT_TRUE(comes_true([&] { return server_.viewers() == 1; })) << "it is still a viewer";
  const std::size_t before = read;
  EXPECT_TRUE(comes_true([&] { return read > before + 2 * large.size(); }));
  EXPECT_EQ(server_.viewers(), 1);
  ::close(never);
  ::close(reads);
}

bool is_ended(int socket) {
  pollfd at{socket, 0, 0};
  return ::poll(&at, 1, 0) == 1 && (at.revents & (POLLERR | POLLHUP)) != 0;
}

TEST_F(HastyPage, ClosesAViewerThatReadsByteByByte) {
  const int s = connect_to(server_.port());
  ASSERT_TRUE(say(s, request("GET /metrics")));
  char byte = 0;
  EXPECT_TRUE(comes_true([&] { return ::recv(s, &byte, 1, MSG_DONTWAIT) == 0 || is_ended(s); }));
  ::close(s);
}

/// Allows two open pages.
class SmallPage : public Served {
 protected:
  static WebSettings settings() {
    WebSettings out = Served::settings();
    out.connections.viewers = 2;
    out.connections.answer_bytes = 4 * kLongAnswer;
    out.metrics = [](const PageUse&) { return std::string(kLongAnswer, '#') + "\n"; };
    return out;
  }
  SmallPage() : Served(settings()) {}

  const Meanwhile tended_{[this] {
    view_.flush();
    server_.wake();
  }};
};

TEST_F(SmallPage, BoundsUnreadAnswersInTotal) {
  std::vector<int> sockets;
  for (int i = 0; i < 50; ++i) {
    sockets.push_back(connect_to(server_.port()));
    ASSERT_TRUE(say(sockets.back(), request("GET /metrics")));
  }
  EXPECT_TRUE(comes_true([&] {
    return std::count_if(sockets.begin(), sockets.end(), is_ended) >= 46;
  })) << std::count_if(sockets.begin(), sockets.end(), is_ended);
  EXPECT_FALSE(is_ended(sockets.back()));
  EXPECT_NE(ask(server_.port(), request("GET /healthz")).find("200 OK"), std::string::npos);
  for (const int s : sockets) ::close(s);
}

TEST_F(SmallPage, RefusesOneViewerTooManyAndTakesTheNextWhenOneLeaves) {
  const auto join = [this] {
    const int s = connect_to(server_.port());
    EXPECT_TRUE(say(s, request("GET /events")));
    char first[13] = "";
    EXPECT_EQ(::recv(s, first, 12, MSG_WAITALL), 12);
    return std::pair{s, std::string(first)};
  };
  const auto [one, one_says] = join();
  const auto [two, two_says] = join();
  const auto [three, three_says] = join();
  EXPECT_EQ(one_says + two_says + three_says, "HTTP/1.1 200HTTP/1.1 200HTTP/1.1 503");
  ::close(one);
  std::string says;
  for (const Clock::time_point since = Clock::now();
       says != "HTTP/1.1 200" && Clock::now() < since + kPatience;
       std::this_thread::sleep_for(kTick)) {
    const auto [again, answer] = join();
    ::close(again);
    says = answer;
  }
  EXPECT_EQ(says, "HTTP/1.1 200");
  ::close(two);
  ::close(three);
}

}  // namespace slow_connections_test
}  // namespace framewatch::daemon
