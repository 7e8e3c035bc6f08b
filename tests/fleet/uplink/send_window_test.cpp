// SPDX-License-Identifier: MIT
#include "fleet/uplink/send_window.h"

#include <string>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace send_window_test {

constexpr std::int64_t kSecond_us = 1'000'000;

Outgoing numbered(int number, std::size_t size = 10) {
  Outgoing out;
  out.message.subject = "fw.up.a.event";
  out.message.headers[header::kKey] = "a/event/" + std::to_string(number);
  out.message.bytes.assign(size, 0);
  out.event = EventKey{"x", number, 0, 1};
  return out;
}

TEST(SendWindow, ResendsAfterTwoSecondsWithoutAcknowledgement) {
  SendWindow w;
  w.add(numbered(1), 0);
  EXPECT_EQ(w.due(0), (std::vector<std::int64_t>{1}));
  EXPECT_TRUE(w.due(SendWindow::kAgain_us - 1).empty());
  w.add(numbered(2), SendWindow::kSilent_us);
  EXPECT_EQ(w.due(SendWindow::kSilent_us), (std::vector<std::int64_t>{2}));
  ASSERT_TRUE(w.acknowledged(2, SendWindow::kSilent_us + 1));
  EXPECT_EQ(w.due(SendWindow::kAgain_us), (std::vector<std::int64_t>{1}));
  EXPECT_EQ(w.sent_again(), 1);
}

TEST(SendWindow, SendsOnlyTheOldestOnceASecondWithoutAcknowledgements) {
  SendWindow w;
  for (int i = 1; i <= 100; ++i) w.add(numbered(i), 0);
  EXPECT_EQ(w.due(0).size(), 100U);
  std::size_t sent = 0;
  for (std::int64_t t = SendWindow::kAgain_us; t < 62 * kSecond_us; t += 10'000) {
    EXPECT_FALSE(w.takes(t));
    for (const std::int64_t number : w.due(t)) {
      EXPECT_EQ(number, 1);
      ++sent;
    }
  }
  EXPECT_EQ(sent, 60U);
  ASSERT_TRUE(w.acknowledged(1, 62 * kSecond_us));
  EXPECT_TRUE(w.takes(62 * kSecond_us));
  EXPECT_EQ(w.due(62 * kSecond_us).size(), 99U);
}

TEST(SendWindow, SendsAnEarthquakeAtOnceAfterQuietHours) {
  SendWindow w;
  w.add(numbered(1), 0);
  (void)w.due(0);
  ASSERT_TRUE(w.acknowledged(1, 1000));
  for (int i = 2; i <= 50; ++i) {
    ASSERT_TRUE(w.takes(7200 * kSecond_us));
    w.add(numbered(i), 7200 * kSecond_us);
  }
  EXPECT_EQ(w.due(7200 * kSecond_us).size(), 49U);
}

TEST(SendWindow, IsBoundedInMessagesAndBytes) {
  SendWindow w;
  int n = 0;
  while (w.takes(0)) w.add(numbered(++n), 0);
  EXPECT_EQ(w.messages(), SendWindow::kMaxMessages);
  SendWindow heavy;
  while (heavy.takes(0)) heavy.add(numbered(++n, 1 << 20), 0);
  EXPECT_LE(heavy.messages(), 5U);
}

TEST(SendWindow, ResendsASingleUnacknowledgedMessageLessAndLessOften) {
  SendWindow w;
  w.add(numbered(1), 0);
  (void)w.due(0);
  std::size_t sent = 0;
  int n = 1;
  for (std::int64_t t = kSecond_us; t <= 600 * kSecond_us; t += kSecond_us) {
    w.add(numbered(++n), t);
    for (const std::int64_t number : w.due(t)) sent += number == 1 ? 1 : 0;
    ASSERT_TRUE(w.acknowledged(n, t));
  }
  EXPECT_GE(sent, 10U);  // once a minute
  EXPECT_LE(sent, 20U);
}

TEST(SendWindow, ARefusedMessageWaitsWithoutDelayingOthers) {
  SendWindow w;
  w.add(numbered(1), 0);
  w.add(numbered(2), 0);
  (void)w.due(0);
  ASSERT_TRUE(w.refused(1, 1000, 60 * kSecond_us));
  EXPECT_EQ(w.due(5 * kSecond_us), (std::vector<std::int64_t>{2}));
  ASSERT_TRUE(w.acknowledged(2, 5 * kSecond_us));
  EXPECT_TRUE(w.due(6 * kSecond_us).empty());
  EXPECT_EQ(w.due(61 * kSecond_us), (std::vector<std::int64_t>{1}));
}

// A full stream of raw samples must not hold up an event.
TEST(SendWindow, TakesMessagesWhileOnlyARefusedOneWaits) {
  SendWindow w;
  w.add(numbered(1), 0);
  (void)w.due(0);
  ASSERT_TRUE(w.refused(1, 1000, 60 * kSecond_us));
  EXPECT_TRUE(w.takes(30 * kSecond_us));
  w.add(numbered(2), 30 * kSecond_us);
  EXPECT_EQ(w.due(30 * kSecond_us), (std::vector<std::int64_t>{2}));
  EXPECT_TRUE(w.takes(31 * kSecond_us));
  EXPECT_FALSE(w.takes(32 * kSecond_us));  // that one has no answer
  ASSERT_TRUE(w.acknowledged(2, 32 * kSecond_us));
  EXPECT_TRUE(w.takes(59 * kSecond_us));
  EXPECT_EQ(w.due(61 * kSecond_us), (std::vector<std::int64_t>{1}));
  ASSERT_TRUE(w.acknowledged(1, 61 * kSecond_us));
  EXPECT_EQ(w.messages(), 0u);
  w.add(numbered(3), 100 * kSecond_us);
  EXPECT_FALSE(w.takes(110 * kSecond_us));
}

TEST(SendWindow, SettlesRepeatedAndLateAnswersOnce) {
  SendWindow w;
  w.add(numbered(1), 0);
  EXPECT_TRUE(w.has("a/event/1"));
  EXPECT_TRUE(w.acknowledged(1, 1));
  EXPECT_FALSE(w.has("a/event/1"));
  EXPECT_FALSE(w.acknowledged(1, 2));
  EXPECT_FALSE(w.acknowledged(99, 3));
  EXPECT_FALSE(w.refused(1, 4, 1));
  EXPECT_EQ(w.bytes(), 0U);
}

TEST(SendWindow, ResendsEverythingOnANewConnection) {
  SendWindow w;
  for (int i = 1; i <= 3; ++i) w.add(numbered(i), 0);
  (void)w.due(0);
  w.reconnected(kSecond_us);
  EXPECT_EQ(w.due(kSecond_us).size(), 3U);
}

}  // namespace send_window_test

namespace verdict_test {

Verdict verdict(const std::string& text) {
  Message answer;
  answer.bytes.assign(text.begin(), text.end());
  return verdict_of(answer);
}

TEST(VerdictTest, AcceptsTheNumberOfAStoredMessage) {
  EXPECT_EQ(verdict(R"({"stream":"FW_EVENT","seq":7})").code, 0);
  EXPECT_FALSE(verdict(R"({"stream":"FW_EVENT","seq":7})").duplicate);
  EXPECT_TRUE(verdict(R"({"stream":"FW_EVENT","seq":7,"duplicate":true})").duplicate);
  EXPECT_FALSE(verdict(R"({"stream":"FW_EVENT","seq":7,"duplicate":"yes"})").duplicate);
}

// nats-server 2.9.10 answers with code 503 in both cases; the error code tells them apart.
TEST(VerdictTest, TellsAFullStreamFromAnAbsentHub) {
  const Verdict full =
      verdict(R"({"error":{"code":503,"err_code":10077,"description":"maximum bytes exceeded"}})");
  EXPECT_NE(full.code, 0);
  EXPECT_NE(full.code, Verdict::kUnavailable);
  EXPECT_EQ(full.why, "maximum bytes exceeded");
  EXPECT_EQ(verdict(R"({"error":{"code":503,"err_code":10008,"description":"unavailable"}})").code,
            Verdict::kUnavailable);
}

TEST(VerdictTest, AMalformedAnswerAcknowledgesNothing) {
  for (const char* bad : {"", "[]", "{}", "7", R"({"error":{}})", R"({"error":7})",
                          R"({"error":{"code":0}})", R"({"error":{"code":99999999999}})"})
    EXPECT_EQ(verdict(bad).code, Verdict::kUnavailable) << bad;
  Message nobody;
  nobody.headers[header::kStatus] = "503";
  EXPECT_EQ(verdict_of(nobody).code, Verdict::kUnavailable);
}

}  // namespace verdict_test

}  // namespace framewatch::fleet
