// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_connections.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {
namespace web_connections_test {

const PeerAddress kHere{"127.0.0.1", true};
PeerAddress elsewhere(int n) {
  return {"192.0.2." + std::to_string(n), false};
}

ConnectionLimits small() {
  ConnectionLimits limits;
  limits.waiting = 8;
  limits.answering = 4;
  limits.viewers = 10;
  limits.viewers_per_address = 5;
  limits.kept_local = 2;
  limits.answer_bytes = 1000;
  return limits;
}

std::vector<int> numbers(const std::vector<WebConnections::Ending>& endings) {
  std::vector<int> out;
  for (const auto& e : endings) out.push_back(e.connection);
  return out;
}

TEST(WebConnections, ReplaceTheOldestOfTheBusiestAddress) {
  WebConnections w(small());
  EXPECT_TRUE(w.opened(1, elsewhere(1), 0).empty());
  for (int i = 2; i <= 8; ++i) EXPECT_TRUE(w.opened(i, elsewhere(2), 0).empty());
  EXPECT_EQ(numbers(w.opened(9, elsewhere(3), 0)), std::vector<int>{2});
  EXPECT_EQ(numbers(w.opened(10, elsewhere(2), 0)), std::vector<int>{3});
  EXPECT_EQ(w.use().waiting, 8);
  EXPECT_EQ(w.use().crowded_out, 2);
  // An ended connection takes no place and is not ended again.
  EXPECT_TRUE(w.asked(2, 0).empty());
  EXPECT_EQ(w.use().answering, 0);
  w.closed(2);
  w.closed(3);
  w.closed(3);
  EXPECT_EQ(w.use().waiting, 8);
}

TEST(WebConnections, TakePlacesReservedForThisMachineLast) {
  WebConnections w(small());
  for (int i = 1; i <= 2; ++i) EXPECT_TRUE(w.opened(i, kHere, 0).empty());
  for (int i = 3; i <= 8; ++i) EXPECT_TRUE(w.opened(i, elsewhere(i), 0).empty());
  for (int i = 9; i <= 100; ++i) {
    const auto ended = w.opened(i, elsewhere(i % 50), 0);
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_NE(ended[0].address, kHere.text);
  }
  EXPECT_EQ(w.use().waiting, 8);
}

TEST(WebConnections, ReserveAPlaceForThisMachine) {
  WebConnections w(small());
  for (int i = 1; i <= 8; ++i) EXPECT_TRUE(w.opened(i, kHere, 0).empty());
  for (int i = 9; i <= 2000; ++i)
    EXPECT_EQ(numbers(w.opened(i, kHere, 0)), std::vector<int>{i - 8});
  EXPECT_TRUE(w.asked(2000, 0).empty());
}

TEST(WebConnections, CountNoProgressForSingleBytes) {
  WebConnections w(small());
  const std::int64_t most_us = small().request_us;
  EXPECT_TRUE(w.opened(1, kHere, 0).empty());
  EXPECT_TRUE(w.opened(2, kHere, 1).empty());
  EXPECT_TRUE(w.overdue(most_us - 1).empty());
  const auto late = w.overdue(most_us);
  ASSERT_EQ(numbers(late), std::vector<int>{1});
  EXPECT_EQ(late[0].why, WebConnections::Why::late_request);
  EXPECT_EQ(late[0].address, "127.0.0.1");
  EXPECT_TRUE(w.overdue(most_us).empty());

  EXPECT_TRUE(w.asked(2, most_us).empty());
  EXPECT_TRUE(w.overdue(most_us + small().answer_us - 1).empty());
  const auto unread = w.overdue(most_us + small().answer_us);
  ASSERT_EQ(numbers(unread), std::vector<int>{2});
  EXPECT_EQ(unread[0].why, WebConnections::Why::late_answer);
  EXPECT_EQ(w.use().late_requests, 1);
  EXPECT_EQ(w.use().late_answers, 1);
}

TEST(WebConnections, KeepViewersAndRefuseTheNextOne) {
  WebConnections w(small());
  const auto views = [&](int connection, const PeerAddress& from) {
    EXPECT_TRUE(w.opened(connection, from, 0).empty());
    EXPECT_TRUE(w.asked(connection, 0).empty());
    return w.watches(connection);
  };
  for (int i = 1; i <= 5; ++i) EXPECT_TRUE(views(i, elsewhere(1)));
  EXPECT_FALSE(views(6, elsewhere(1))) << "of one address";
  w.closed(6);
  for (int i = 7; i <= 9; ++i) EXPECT_TRUE(views(i, elsewhere(2)));
  EXPECT_FALSE(views(10, elsewhere(2))) << "the last two are this machine's";
  w.closed(10);
  EXPECT_TRUE(views(11, kHere));
  EXPECT_TRUE(views(12, kHere));
  EXPECT_FALSE(views(13, kHere));
  EXPECT_EQ(w.use().viewers, 10);
  EXPECT_EQ(w.use().viewers_refused, 3);
  EXPECT_TRUE(numbers(w.overdue(std::int64_t{1} << 60)) == std::vector<int>{13});
  w.closed(1);
  w.closed(13);
  EXPECT_TRUE(views(14, kHere));
  EXPECT_FALSE(w.watches(99));
}

TEST(WebConnections, BoundUnreadAnswers) {
  WebConnections w(small());
  const auto ask = [&](int connection, std::size_t bytes) {
    EXPECT_TRUE(w.opened(connection, kHere, 0).empty());
    std::vector<int> out = numbers(w.asked(connection, 0));
    for (const int ended : numbers(w.answered(connection, bytes))) out.push_back(ended);
    return out;
  };
  EXPECT_TRUE(ask(1, 400).empty());
  EXPECT_TRUE(ask(2, 400).empty());
  EXPECT_EQ(ask(3, 400), (std::vector<int>{1}));
  EXPECT_EQ(ask(4, 1000), (std::vector<int>{2, 3}));
  EXPECT_EQ(ask(5, 2000), (std::vector<int>{4})) << "one answer alone may be larger";
  w.closed(5);
  for (int i = 6; i <= 9; ++i) EXPECT_TRUE(ask(i, 0).empty());
  EXPECT_EQ(ask(10, 0), (std::vector<int>{6})) << "no more than four at once";
}

}  // namespace web_connections_test
}  // namespace framewatch::daemon
