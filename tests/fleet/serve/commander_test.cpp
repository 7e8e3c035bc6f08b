// SPDX-License-Identifier: MIT
#include "fleet/serve/commander.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/acknowledge_t.hpp>

#include "drivers/lcm/message_check.h"

namespace framewatch::fleet {
namespace commander_test {

constexpr std::int64_t kUtc_us = 1'795'305'600'000'000;

/// Buildings give the answers in answers_; others do not answer.
class Line : public Link {
 public:
  bool up = true;
  std::vector<Message> sent;
  std::vector<Message> coming;

  bool publish(const Message& message) override {
    if (!up) return false;
    sent.push_back(message);
    return true;
  }
  void listen(const std::string&) override {}
  std::vector<Message> take() override { return std::exchange(coming, {}); }
  std::int64_t connections() const override { return 1; }
  bool is_connected() const override { return up; }
  std::string trouble() const override { return ""; }
  std::string inbox() const override { return "_INBOX_page.x"; }

  void answer(std::size_t which, const std::string& text) {
    Message m{sent[which].reply, "", {}, {text.begin(), text.end()}};
    coming.push_back(std::move(m));
  }
  void nobody(std::size_t which) {
    coming.push_back({sent[which].reply, "", {{header::kStatus, "503"}}, {}});
  }
};

class CommanderAtWork : public testing::Test {
 protected:
  CommandOrder order(const std::string& verb, const std::string& content = "{}") {
    return {"page-1", "alice", verb, content, {{1, "kobe-03"}, {2, "osaka"}}};
  }
  Line line_;
  std::vector<CommandResult> results_;
  Commander commander_{line_, [this](const CommandResult& r) { results_.push_back(r); }};
};

TEST_F(CommanderAtWork, AsksEachBuildingAndReturnsItsAnswer) {
  ASSERT_TRUE(commander_.give(order("minutes", R"({"from_us":1,"to_us":2})")));
  commander_.step(0, kUtc_us);
  ASSERT_EQ(line_.sent.size(), 2u);
  const Message& m = line_.sent[0];
  EXPECT_EQ(m.subject, "fw.down.kobe-03.minutes");
  EXPECT_EQ(m.header(header::kWho), "alice");
  EXPECT_EQ(m.header(header::kRequest), "page-1");
  EXPECT_EQ(m.header(header::kUntil), std::to_string(kUtc_us / 1'000'000 + 30));
  EXPECT_EQ(std::string(m.bytes.begin(), m.bytes.end()), R"({"from_us":1,"to_us":2})");
  line_.answer(1, R"({"ok":true})");
  line_.answer(0, R"({"ok":false,"why":"does not\naccept it"})");
  line_.answer(1, R"({"ok":false})");
  commander_.step(1, kUtc_us);
  ASSERT_EQ(results_.size(), 2u);
  EXPECT_EQ(results_[0].building, 2);
  EXPECT_TRUE(results_[0].done);
  EXPECT_EQ(results_[1].building, 1);
  EXPECT_EQ(results_[1].answer.find('\n'), std::string::npos);
}

TEST_F(CommanderAtWork, ReportsAbsentBuildings) {
  ASSERT_TRUE(commander_.give(order("ping")));
  commander_.step(0, kUtc_us);
  line_.nobody(0);
  commander_.step(Commander::kWait_us - 1, kUtc_us);
  ASSERT_EQ(results_.size(), 1u);
  EXPECT_EQ(results_[0].answer, "the building is not connected");
  commander_.step(Commander::kWait_us, kUtc_us);
  ASSERT_EQ(results_.size(), 2u);
  EXPECT_EQ(results_[1].answer, "no answer in time");
  line_.answer(1, R"({"ok":true})");
  commander_.step(Commander::kWait_us + 1, kUtc_us);
  EXPECT_EQ(results_.size(), 2u);
}

TEST_F(CommanderAtWork, KeepsNoCommandWithoutAHub) {
  line_.up = false;
  ASSERT_TRUE(commander_.give(order("ping")));
  commander_.step(0, kUtc_us);
  ASSERT_EQ(results_.size(), 2u);
  EXPECT_EQ(results_[0].answer, "the hub is not connected");
  line_.up = true;
  commander_.step(1, kUtc_us);
  EXPECT_TRUE(line_.sent.empty());
}

TEST_F(CommanderAtWork, IgnoresMalformedAnswers) {
  for (const std::string& text : {std::string("nonsense"), std::string(R"({"ok":1})"),
                                  std::string(70'000, ' '), std::string("[]")}) {
    results_.clear();
    line_.sent.clear();
    ASSERT_TRUE(commander_.give(order("ping")));
    commander_.step(0, kUtc_us);
    line_.answer(0, text);
    commander_.step(1, kUtc_us);
    ASSERT_EQ(results_.size(), 1u);
    EXPECT_FALSE(results_[0].done);
  }
}

TEST_F(CommanderAtWork, RefusesTooManyCommands) {
  for (std::size_t i = 0; i < Commander::kMaxOrders; ++i)
    ASSERT_TRUE(commander_.give(order("ping")));
  EXPECT_FALSE(commander_.give(order("ping")));
}

TEST_F(CommanderAtWork, SendsAnAcknowledgementAsTheDaemonsMessage) {
  ASSERT_TRUE(commander_.give(order("acknowledge", R"({"id":7,"comment":"seen"})")));
  commander_.step(0, kUtc_us);
  const auto request = drivers::decoded<acknowledge_t>(line_.sent[0].bytes);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->id, 7);
  EXPECT_EQ(request->who, "alice");
  EXPECT_EQ(request->comment, "seen");
}

TEST(CommandContent, RefusesMalformedCommandsWithTheReason) {
  std::string why;
  for (const CommandWords& words :
       {CommandWords{"erase", "", "", "", "", ""}, CommandWords{"minutes", "1", "x", "", "", ""},
        CommandWords{"raw", "2", "1", "", "", ""}, CommandWords{"acknowledge", "", "", "", "0", ""},
        CommandWords{"acknowledge", "", "", "", "1", std::string(501, 'a')}}) {
    why.clear();
    EXPECT_FALSE(command_content(words, why)) << words.verb;
    EXPECT_FALSE(why.empty());
  }
  EXPECT_EQ(command_content({"raw", "1", "2", "base, roof", "", ""}, why),
            R"({"channels":["base","roof"],"from_us":1,"to_us":2})");
  EXPECT_EQ(command_content({"ping", "", "", "", "", ""}, why), "{}");
}

}  // namespace commander_test
}  // namespace framewatch::fleet
