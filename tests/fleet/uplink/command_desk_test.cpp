// SPDX-License-Identifier: MIT
#include "fleet/uplink/command_desk.h"

#include "drivers/files/encoded.h"
#include "tests/fleet/uplink/uplink_fixture.h"

namespace framewatch::fleet {
namespace command_desk_test {

class Commands : public test::UplinkTest {
 protected:
  /// Returns a command as the hub's page sends it.
  Message command(const std::string& verb, const std::string& request, const std::string& text) {
    Message m;
    m.subject = "fw.down.a." + verb;
    m.reply = "_INBOX_page.x." + request;
    m.headers[header::kWho] = "Ada";
    m.headers[header::kRequest] = request;
    m.headers[header::kUntil] = std::to_string(host_us_ / test::kSecond + 60);
    m.bytes.assign(text.begin(), text.end());
    return m;
  }
  /// Returns the answer; empty if there is none.
  std::string answer(const Message& m) {
    hub_.answered.clear();
    hub_.bring(m);
    run(0.05);
    if (hub_.answered.size() != 1) return "";
    EXPECT_EQ(hub_.answered[0].subject, m.reply);
    return {hub_.answered[0].bytes.begin(), hub_.answered[0].bytes.end()};
  }
};

constexpr const char* kDone = R"({"ok":true})";

std::string range(std::int64_t from_us, std::int64_t to_us) {
  return fmt::format(R"({{"from_us":{},"to_us":{}}})", from_us, to_us);
}

TEST_F(Commands, ListensForItsOwnAndCommonCommands) {
  begin();
  EXPECT_EQ(hub_.subjects, (std::vector<std::string>{"fw.down.a.>", "fw.down.all.>"}));
  EXPECT_EQ(answer(command("ping", "r1", "")), kDone);
}

TEST_F(Commands, PassesAnAcknowledgementWithItsAuthorToTheDaemon) {
  begin();
  acknowledge_t request{};
  request.id = 3;
  request.who = "somebody else";
  const auto bytes = drivers::encoded(request);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_EQ(answer(command("acknowledge", "r1", text)), kDone);
  ASSERT_EQ(acknowledged_.size(), 1U);
  EXPECT_EQ(acknowledged_[0].id, 3);
  EXPECT_EQ(acknowledged_[0].who, "Ada");
  acknowledge_problem_ = "no such event is raised";
  EXPECT_NE(answer(command("acknowledge", "r2", text)).find("no such event"), std::string::npos);
  EXPECT_NE(answer(command("acknowledge", "r3", "x")).find("expected an acknowledge_t"),
            std::string::npos);
}

TEST_F(Commands, ObeysARepeatedCommandOnce) {
  begin();
  const auto bytes = drivers::encoded(acknowledge_t{});
  const Message m = command("acknowledge", "r1", {bytes.begin(), bytes.end()});
  EXPECT_EQ(answer(m), kDone);
  EXPECT_EQ(answer(m), kDone);
  uplink_.reset();
  begin();
  run(1);
  EXPECT_EQ(answer(m), kDone);
  EXPECT_EQ(acknowledged_.size(), 1U);
}

TEST_F(Commands, RefusesCommandsThatTheBuildingForbids) {
  settings_.accept = {"raw"};
  begin();
  const auto bytes = drivers::encoded(acknowledge_t{});
  EXPECT_NE(answer(command("acknowledge", "r1", {bytes.begin(), bytes.end()})).find("not accept"),
            std::string::npos);
  EXPECT_NE(answer(command("reboot", "r2", "")).find("not accept"), std::string::npos);
  EXPECT_TRUE(acknowledged_.empty());
  EXPECT_EQ(uplink_->status(now()).commands_refused, 2);
}

TEST_F(Commands, RefusesOldAndAnonymousCommands) {
  begin();
  const std::string good = range(0, 1);
  const auto refused = [&](const std::string& number, auto change) {
    Message m = command("minutes", number, good);
    change(m);
    return answer(m).find(R"("ok":false)") != std::string::npos;
  };
  EXPECT_FALSE(refused("r0", [](Message&) {}));
  EXPECT_TRUE(refused("r1", [&](Message& m) {
    m.headers[header::kUntil] = std::to_string(host_us_ / test::kSecond - 5);
  }));
  EXPECT_TRUE(refused("r2", [&](Message& m) {
    m.headers[header::kUntil] = std::to_string(host_us_ / test::kSecond + 7200);
  }));
  EXPECT_TRUE(refused("r3", [](Message& m) { m.headers[header::kUntil] = "soon"; }));
  EXPECT_TRUE(refused("r4", [](Message& m) { m.headers.erase(header::kUntil); }));
  EXPECT_TRUE(refused("r5", [](Message& m) { m.headers.erase(header::kWho); }));
  EXPECT_TRUE(refused("r6", [](Message& m) { m.headers.erase(header::kRequest); }));
  EXPECT_TRUE(refused("r7", [](Message& m) { m.headers[header::kRequest] = "../../etc/x"; }));
  EXPECT_TRUE(refused("r8", [](Message& m) { m.bytes.assign(70'000, ' '); }));
}

TEST_F(Commands, RefusesMalformedStretches) {
  begin();
  int number = 0;
  for (const std::string& bad :
       {std::string(""), std::string("[]"), std::string("{}"), range(5, 5), range(6, 5),
        std::string(R"({"from_us":0.5,"to_us":2})"), std::string(R"({"from_us":"0","to_us":2})"),
        range(INT64_MIN, INT64_MAX), range(0, 500 * 24 * test::kHour_us), std::string(3000, '[')})
    EXPECT_NE(answer(command("minutes", fmt::format("r{}", ++number), bad)).find(R"("ok":false)"),
              std::string::npos)
        << bad;
}

TEST_F(Commands, ResendSendsStoredMessagesAgain) {
  for (int i = 0; i < 10; ++i) add_event(i, test::kStart_us + i * test::kHour_us);
  begin();
  run(5);
  EXPECT_EQ(kept_twice(), 0U);
  EXPECT_EQ(
      answer(command("resend", "r1", range(test::kStart_us, test::kStart_us + 3 * test::kHour_us))),
      kDone);
  run(5);
  EXPECT_EQ(kept_twice(), 3U);
}

// A stream accepts one Nats-Msg-Id only once within minutes, but here the database lacks the
// message.
TEST_F(Commands, TheHubAcceptsMessagesSentAgainOnCommand) {
  secret_ = "mine";
  for (int i = 0; i < 10; ++i) add_event(i, test::kStart_us + i * test::kHour_us);
  begin();
  run(5);
  EXPECT_EQ(hub_.count("a/event/"), 10U);
  EXPECT_EQ(
      answer(command("resend", "r1", range(test::kStart_us, test::kStart_us + 3 * test::kHour_us))),
      kDone);
  run(5);
  EXPECT_EQ(hub_.count("a/event/"), 13U);
  EXPECT_EQ(kept_twice(), 0U);
}

TEST_F(Commands, SendsRequestedMinutesIncludingFutureOnes) {
  add_hour(test::kStart_us);
  begin();
  run(3);
  EXPECT_EQ(hub_.count("a/summary/60/"), 0U);
  EXPECT_EQ(answer(command("minutes", "r1",
                           range(test::kStart_us + 3000 * test::kSecond,
                                 test::kStart_us + 4200 * test::kSecond))),
            kDone);
  run(3);
  EXPECT_EQ(hub_.count("a/summary/60/"), 10U);
  add_hour(test::kStart_us + test::kHour_us);
  run(5);
  EXPECT_EQ(hub_.count("a/summary/60/"), 20U);
}

}  // namespace command_desk_test
}  // namespace framewatch::fleet
