// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/monitor/actions/acknowledge.h"
#include "daemon/monitor/actions/note.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/history/summary_query.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/lcm_source.h"
#include "drivers/lcm/message_check.h"
#include "estimator/state/archive.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace acknowledge_test {

using namespace std::chrono_literals;

// Limits.
constexpr auto kSoon = 60s;  // for actions that take a second or two on an idle machine

event_t event(std::int64_t id, int state = event_state::raised) {
  event_t e{};
  e.id = id;
  e.state = state;
  e.kind = "gap";
  e.place = "F1-Y1";
  return e;
}

TEST(RaisedEvents, ForgetAnAcknowledgementWhenTheEventIsCleared) {
  RaisedEvents raised;
  raised.note(event(1));
  raised.note(event(2));
  raised.acknowledge(1, {5, "me", "loose"});
  raised.acknowledge(1, {6, "you", "fixed"});
  ASSERT_NE(raised.acknowledgement(1), nullptr);
  EXPECT_EQ(raised.acknowledgement(1)->who, "you");
  EXPECT_EQ(raised.acknowledgement(2), nullptr);
  raised.note(event(1, event_state::changed));
  EXPECT_NE(raised.acknowledgement(1), nullptr);
  raised.note(event(1, event_state::cleared));
  EXPECT_EQ(raised.acknowledgement(1), nullptr);
  raised.note(event(1));
  EXPECT_EQ(raised.acknowledgement(1), nullptr);
}

TEST(RaisedEvents, KeepAcknowledgementsInTheState) {
  RaisedEvents raised, again;
  raised.note(event(1));
  raised.acknowledge(1, {5, "me", "loose"});
  estimator::StateWriter writer;
  writer(raised);
  estimator::StateReader reader(writer.bytes());
  reader(again);
  ASSERT_NE(again.acknowledgement(1), nullptr);
  EXPECT_EQ(again.acknowledgement(1)->time_us, 5);
  EXPECT_EQ(again.acknowledgement(1)->comment, "loose");
}

class Desk : public testing::Test {
 protected:
  Desk() { lcm_.subscribe("FRAMEWATCH_ACKNOWLEDGED", &Desk::on_answer, this); }
  void on_answer(const lcm::ReceiveBuffer* buffer, const std::string&) {
    auto found = drivers::decoded<acknowledged_t>(
        {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size});
    ASSERT_TRUE(found);
    answers_.push_back(std::move(*found));
  }
  std::optional<acknowledged_t> ask(const acknowledge_t& request, std::int64_t now_us = 5) {
    return desk_.obey(drivers::encoded(request), "alice", {&here_, &there_}, now_us);
  }
  void look(std::int64_t now_us) {
    desk_.update({&here_, &there_}, now_us);
    while (lcm_.handleTimeout(50) > 0) {
    }
  }

  Config config_;
  lcm::LCM lcm_{"memq://"};
  RaisedEvents here_, there_;
  std::vector<acknowledged_t> answers_;
  std::vector<std::int64_t> done_;
  AcknowledgeDesk desk_{config_, lcm_, [this](const event_t& e, auto&) { done_.push_back(e.id); }};
};

TEST_F(Desk, AnswersOnceAndPublishesAcknowledgementsEverySecond) {
  here_.note(event(1));
  there_.note(event(2));
  look(0);
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_EQ(answers_[0].events, 0);
  const acknowledge_t request = acknowledge_request(2, "", "loose");
  for (int again = 0; again < 2; ++again) {
    const auto answer = ask(request);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->answered, request.request);
    EXPECT_EQ(answer->refused, "");
    EXPECT_EQ(answer->id, std::vector<std::int64_t>{2});
    EXPECT_EQ(answer->who, std::vector<std::string>{"alice"});
  }
  look(10);
  ASSERT_EQ(answers_.size(), 2u);
  EXPECT_EQ(done_, std::vector<std::int64_t>{2});
  EXPECT_EQ(answers_[1].answered, request.request);
  EXPECT_EQ(answers_[1].refused, "");
  EXPECT_EQ(answers_[1].id, std::vector<std::int64_t>{2});
  EXPECT_EQ(answers_[1].comment, std::vector<std::string>{"loose"});
  look(500'000);
  EXPECT_EQ(answers_.size(), 2u);
  look(1'000'010);
  EXPECT_EQ(answers_.size(), 3u);
}

TEST_F(Desk, RefusesEventsThatAreNotRaisedAndAcceptsAll) {
  EXPECT_EQ(ask(acknowledge_request(9, "", ""))->refused, "no event 9 is raised");
  EXPECT_EQ(ask(acknowledge_request(0, "", ""))->refused, "no event is raised");
  here_.note(event(1));
  here_.acknowledge(1, {1, "somebody else", ""});
  here_.note(event(3));
  there_.note(event(2));
  EXPECT_EQ(ask(acknowledge_request(0, "", ""))->events, 3);
  EXPECT_EQ(done_, (std::vector<std::int64_t>{3, 2}));
  EXPECT_EQ(here_.acknowledgement(1)->who, "somebody else");
}

TEST_F(Desk, PublishesWhenEverythingWasAcknowledged) {
  here_.note(event(1));
  ask(acknowledge_request(kAllEvents, "", "seen"), 7);
  look(0);
  ASSERT_EQ(answers_.size(), 1u);
  EXPECT_EQ(answers_[0].id, (std::vector<std::int64_t>{1, kAllEvents}));
  EXPECT_EQ(answers_[0].since_us[1], 7);
  EXPECT_EQ(answers_[0].comment[1], "seen");
  // A page may have events that run does not have.
  here_.note(event(1, event_state::cleared));
  ask(acknowledge_request(kAllEvents, "", ""), 9);
  look(10);
  EXPECT_EQ(answers_[1].id, std::vector<std::int64_t>{kAllEvents});
  EXPECT_EQ(answers_[1].since_us[0], 9);
}

TEST_F(Desk, IgnoresMalformedRequests) {
  const std::vector<std::uint8_t> junk = {'j', 'u', 'n', 'k'};
  EXPECT_FALSE(desk_.obey(junk, "alice", {&here_}, 5));
  config_.lcm.commands = true;
  desk_.heard(junk, 5);
  desk_.heard({}, 5);
  look(0);
  EXPECT_EQ(answers_.size(), 1u);
}

TEST_F(Desk, UsesItsOwnClockAndTheVerifiedName) {
  here_.note(event(1));
  acknowledge_t request = acknowledge_request(1, "Bob", "a\n<3>framewatch: forged\x1b[2J");
  request.time_us = 77;
  testing::internal::CaptureStderr();
  ask(request, 5);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(here_.acknowledgement(1)->time_us, 5);
  EXPECT_EQ(here_.acknowledgement(1)->who, "alice (says: Bob)");
  EXPECT_EQ(here_.acknowledgement(1)->comment, "a\\n<3>framewatch: forged\\x1b[2J");
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_EQ(said.find('\x1b'), std::string::npos);
  request = acknowledge_request(1, std::string(5000, '\xff'), std::string(5000, 'c'));
  ask(request);
  EXPECT_LT(here_.acknowledgement(1)->who.size(), 200u);
  EXPECT_LE(here_.acknowledgement(1)->comment.size(), 500u);
}

TEST_F(Desk, TheAnswerAlwaysFitsAPacket) {
  for (int i = 1; i <= static_cast<int>(RaisedEvents::kMax); ++i) here_.note(event(i));
  const auto answer = ask(acknowledge_request(0, std::string(500, 'w'), std::string(500, 'c')));
  ASSERT_TRUE(answer);
  EXPECT_EQ(done_.size(), RaisedEvents::kMax);
  EXPECT_LT(drivers::encoded(*answer).size(), 60'000u);
}

TEST_F(Desk, ObeysLcmRequestsIfConfigured) {
  here_.note(event(1));
  const std::vector<std::uint8_t> request = drivers::encoded(acknowledge_request(1, "Bob", ""));
  testing::internal::CaptureStderr();
  for (int i = 0; i < 1000; ++i) desk_.heard(request, 5);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(desk_.not_obeyed(), 1000);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_NE(said.find("lcm.commands = false"), std::string::npos) << said;
  look(10);
  EXPECT_EQ(here_.acknowledgement(1), nullptr);
  config_.lcm.commands = true;
  for (int i = 0; i < 1000; ++i) desk_.heard(request, 15);
  look(20);
  ASSERT_NE(here_.acknowledgement(1), nullptr);
  EXPECT_EQ(here_.acknowledgement(1)->who, "LCM (says: Bob)");
  EXPECT_EQ(done_, std::vector<std::int64_t>{1});
  EXPECT_EQ(desk_.not_obeyed(), 1000);
}

// The daemon, its command and its history.

/// The tower, whose CAN bus is missing, which raises an alarm.
class Tower : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
    std::filesystem::copy(FRAMEWATCH_SOURCE_DIR "/configs/can", directory_.path("can"));
    test::write_file(directory_.path("hook"),
                     "#!/bin/sh\necho \"$FRAMEWATCH_STATE "
                     "$FRAMEWATCH_KIND $FRAMEWATCH_EVENT_ID\" >>" +
                         directory_.path("told") + "\n");
    std::filesystem::permissions(directory_.path("hook"), std::filesystem::perms::owner_all);
    add("[history]\ndirectory = \"h\"\n[commands]\ndirectory = \"../commands\"\n[actions]\ncommand "
        "= "
        "[\"" +
        directory_.path("hook") + "\"]\n");
    std::string error;
    lcm_ = drivers::open_lcm(LcmSettings().url, {}, error);
    ASSERT_TRUE(lcm_) << error;
    source_.emplace(*lcm_, std::vector<std::string>{"FRAMEWATCH_ACKNOWLEDGED"}, 100,
                    [this](const drivers::LcmMessage& m) {
                      known_ = drivers::decoded<acknowledged_t>(
                          {static_cast<const std::uint8_t*>(m.data), m.size});
                    });
  }
  /// Appends a text to the configuration.
  void add(const std::string& text) const {
    test::write_file(config(), test::read_file(config()) + "\n" + text);
  }
  std::string config() const { return directory_.path("can/tower.toml"); }
  std::string told() const { return test::read_file(directory_.path("told")); }
  test::Child run() const {
    return test::Child({FRAMEWATCH_PROGRAM, "run", config(), "--state", directory_.path("state"),
                        "--state-every", "1", "--quiet"});
  }
  int acknowledge(std::int64_t id) const {
    AcknowledgeArguments arguments;
    arguments.event = std::to_string(id);
    arguments.config = config();
    arguments.who = "me";
    arguments.comment = "no bus here";
    return acknowledge_command(arguments);
  }
  /// Returns the id of a raised event of the daemon.
  std::int64_t raised() const {
    EXPECT_TRUE(test::comes_true([&] { return told().ends_with('\n'); }, kSoon));
    return told().starts_with("raised interface_gone ") ? std::stoll(told().substr(22)) : 0;
  }
  /// Sends a request as any process on the bus can.
  void forge(std::int64_t id) {
    const acknowledge_t request = acknowledge_request(id, "anybody", "x");
    lcm_->publish("FRAMEWATCH_ACKNOWLEDGE", &request);
  }
  template <typename Condition>
  bool heard(Condition condition) {
    return test::comes_true(
        [&] {
          (void)source_->handle(10);
          return known_ && condition(*known_);
        },
        kSoon);
  }

  test::TemporaryDirectory directory_;
  std::unique_ptr<drivers::LcmProvider> lcm_;
  std::optional<drivers::LcmSource> source_;
  std::optional<acknowledged_t> known_;
};

TEST_F(Tower, AnAcknowledgementSurvivesARestartAndIsInTheHistory) {
  std::int64_t id = 0;
  {
    test::Child daemon = run();
    id = raised();
    ASSERT_NE(id, 0);
    EXPECT_EQ(acknowledge(id + 1), 1);
    EXPECT_EQ(acknowledge(id), 0);
    EXPECT_EQ(daemon.stop(SIGTERM), 0);
  }
  known_.reset();
  const std::int64_t again_us = host_clock_us();
  {
    test::Child daemon = run();
    EXPECT_TRUE(heard([&](const acknowledged_t& a) {
      return a.time_us > again_us && a.id == std::vector<std::int64_t>{id} &&
             a.comment[0] == "no bus here";
    }));
    EXPECT_EQ(daemon.stop(SIGTERM), 0);
  }
  EXPECT_EQ(told(), "raised interface_gone " + std::to_string(id) + "\n");
  SummaryQuery history;
  ASSERT_EQ(history.open(directory_.path("can/h")), "");
  const auto stored = history.acknowledgements(0, INT64_MAX);
  ASSERT_EQ(stored.size(), 1u);
  EXPECT_EQ(stored[0].id, id);
  EXPECT_EQ(stored[0].kind, "interface_gone");
  EXPECT_EQ(stored[0].who, user_name(::geteuid()) + " (says: me)");
  EXPECT_EQ(acknowledge(id), 2);  // no daemon runs
  EXPECT_EQ(acknowledge_command({"3x", config(), "", ""}), 2);
}

TEST_F(Tower, ANoteIsInTheHistory) {
  NoteArguments note;
  note.text = "bookshelves";
  note.config = config();
  note.at = "2026-01-02";
  note.who = "Jo";
  EXPECT_EQ(note_command(note), 2);  // no daemon runs
  {
    test::Child daemon = run();
    ASSERT_NE(raised(), 0);
    EXPECT_EQ(note_command(note), 0);
    note.maintenance = true;
    EXPECT_EQ(note_command(note), 0);
    note.at = "yesterday";
    EXPECT_EQ(note_command(note), 2);
    note.at = "2199-01-01";
    EXPECT_EQ(note_command(note), 1);
    note.at = "";
    note.text = " ";
    EXPECT_EQ(note_command(note), 1);
    EXPECT_EQ(daemon.stop(SIGTERM), 0);
  }
  SummaryQuery history;
  ASSERT_EQ(history.open(directory_.path("can/h")), "");
  const auto stored = history.acknowledgements(0, INT64_MAX);
  ASSERT_EQ(stored.size(), 2u);
  for (const StoredAcknowledgement& s : stored) {
    EXPECT_TRUE(is_note(s));
    EXPECT_EQ(s.time_us, 20'455 * kDay_us);
    EXPECT_EQ(s.who, user_name(::geteuid()) + " (says: Jo)");
    EXPECT_EQ(s.comment, "bookshelves");
  }
  EXPECT_EQ(history.maintenance_days(), std::vector<std::int64_t>{20'455});
}

TEST(Note, NeedsATextAndATimeThatHasPassed) {
  constexpr std::int64_t kNow_us = 20'000 * kDay_us;
  const auto why = [&](std::int64_t sort, const std::string& text, std::int64_t time_us) {
    acknowledge_t request = acknowledge_request(sort, "", text);
    request.time_us = time_us;
    std::string out;
    const bool kept = note_of(request, "alice", kNow_us, out).has_value();
    EXPECT_EQ(kept, out.empty());
    return out;
  };
  EXPECT_EQ(why(kPlainNote, "x", kNow_us), "");
  EXPECT_EQ(why(kMaintenance, std::string(500, 'x'), 0), "");
  EXPECT_EQ(why(kPlainNote, " \n", kNow_us), "a note needs a text");
  EXPECT_EQ(why(kPlainNote, std::string(501, 'x'), kNow_us),
            "a note has at most 500 bytes, not 501");
  EXPECT_EQ(why(7, "x", kNow_us),
            "7 is an unknown sort of note: is the program from another version?");
  EXPECT_NE(why(kPlainNote, "x", -1).find("about the past"), std::string::npos);
  EXPECT_NE(why(kPlainNote, "x", kNow_us + 2 * kDay_us).find("about the past"), std::string::npos);
  EXPECT_NE(why(kPlainNote, "x", INT64_MAX).find("about the past"), std::string::npos);
}

TEST(Note, IsOneLineAndNamesItsAuthor) {
  acknowledge_t request = acknowledge_request(kMaintenance, "Bob", "a\nwall\x1b[2J");
  request.time_us = 5;
  std::string why;
  const auto note = note_of(request, "alice", 10, why);
  ASSERT_TRUE(note) << why;
  EXPECT_EQ(note->event.kind, kMaintenanceKind);
  EXPECT_EQ(note->event.id, request.request);
  EXPECT_EQ(note->by.time_us, 5);
  EXPECT_EQ(note->by.who, "alice (says: Bob)");
  EXPECT_EQ(note->by.comment, "a\\nwall\\x1b[2J");
}

TEST_F(Tower, ADatagramAcknowledgesNothing) {
  test::Child daemon = run();
  const std::int64_t id = raised();
  ASSERT_NE(id, 0);
  ASSERT_TRUE(heard([&](const acknowledged_t&) { return true; }));
  for (int i = 0; i < 20; ++i) forge(id);
  const std::int64_t then_us = host_clock_us();
  // By then its loop has run many times.
  ASSERT_TRUE(heard([&](const acknowledged_t& a) { return a.time_us > then_us + 2 * kSecond_us; }));
  EXPECT_EQ(known_->events, 0);
  EXPECT_EQ(acknowledge(id), 0);
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
}

TEST_F(Tower, ADatagramAcknowledgesIfLcmCommandsAreEnabled) {
  add("[lcm]\ncommands = true\n");
  test::Child daemon = run();
  const std::int64_t id = raised();
  ASSERT_NE(id, 0);
  EXPECT_TRUE(heard([&](const acknowledged_t& a) {
    forge(id);
    return a.events == 1 && a.who[0] == "LCM (says: anybody)";
  }));
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
}

}  // namespace acknowledge_test
}  // namespace framewatch::daemon
