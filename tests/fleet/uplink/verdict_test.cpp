#include "fleet/uplink/send_window.h"

#include <string>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace verdict_test {

Verdict verdict(const std::string& text) {
  Message answer;
  answer.bytes.assign(text.begin(), text.end());
  return verdict_of(answer);
}

TEST(VerdictTest, AStreamThatHasTheMessageSaysItsNumber) {
  EXPECT_EQ(verdict(R"({"stream":"FW_EVENT","seq":7})").code, 0);
  EXPECT_FALSE(verdict(R"({"stream":"FW_EVENT","seq":7})").duplicate);
  EXPECT_TRUE(verdict(R"({"stream":"FW_EVENT","seq":7,"duplicate":true})").duplicate);
  EXPECT_FALSE(verdict(R"({"stream":"FW_EVENT","seq":7,"duplicate":"yes"})").duplicate);
}

// The same 503, by nats-server 2.9.10.
TEST(VerdictTest, AFullStreamIsNoHubThatIsAway) {
  const Verdict full =
      verdict(R"({"error":{"code":503,"err_code":10077,"description":"maximum bytes exceeded"}})");
  EXPECT_NE(full.code, 0);
  EXPECT_NE(full.code, Verdict::kUnavailable);
  EXPECT_EQ(full.why, "maximum bytes exceeded");
  EXPECT_EQ(verdict(R"({"error":{"code":503,"err_code":10008,"description":"unavailable"}})").code,
            Verdict::kUnavailable);
}

TEST(VerdictTest, WhatIsNoAnswerAcknowledgesNothing) {
  for (const char* bad : {"", "[]", "{}", "7", R"({"error":{}})", R"({"error":7})",
                          R"({"error":{"code":0}})", R"({"error":{"code":99999999999}})"})
    EXPECT_EQ(verdict(bad).code, Verdict::kUnavailable) << bad;
  Message nobody;
  nobody.headers[header::kStatus] = "503";
  EXPECT_EQ(verdict_of(nobody).code, Verdict::kUnavailable);
}

}  // namespace verdict_test
}  // namespace framewatch::fleet
