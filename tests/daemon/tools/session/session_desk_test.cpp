// SPDX-License-Identifier: MIT
#include "daemon/tools/session/session_desk.h"

#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/service/command_client.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/daemon/tools/session/recorder_bench.h"

namespace framewatch::daemon {
namespace session_desk_test {

struct DeskBench : test::RecorderBench {
  DeskBench() { config.commands.directory = directory.path("commands"); }

  /// Runs the recorder's desk and returns its answers.
  CommandAnswer give(SessionDesk& desk, const CommandPacket& command) const {
    auto answer = std::async(std::launch::async, give_command, config, "record", command);
    while (answer.wait_for(std::chrono::milliseconds(5)) != std::future_status::ready) desk.poll();
    return answer.get();
  }
};

session_command_t command(const std::string& verb) {
  return session_command(verb, {"test", "me", "", 0, 0, 0});
}

TEST(SessionDesk, ObeysAndAnswersACommandOverTheSocket) {
  DeskBench b;
  SessionDesk desk(b.config, b.recorder);
  const session_command_t stop = command("stop"), start = command("start");
  CommandAnswer answer = b.give(desk, {"SESSION_COMMAND", drivers::encoded(stop)});
  auto status = drivers::decoded<session_status_t>(answer.bytes);
  ASSERT_TRUE(status) << answer.problem;
  EXPECT_EQ(status->answered, stop.id);
  EXPECT_EQ(status->refused, "nothing is armed or recorded");
  answer = b.give(desk, {"SESSION_COMMAND", drivers::encoded(start)});
  status = drivers::decoded<session_status_t>(answer.bytes);
  ASSERT_TRUE(status) << answer.problem;
  EXPECT_EQ(status->refused, "");
  EXPECT_EQ(b.recorder.state(), RecorderState::recording);
  EXPECT_NE(b.give(desk, {"ACKNOWLEDGE", {}}).problem, "");
  EXPECT_NE(b.give(desk, {"SESSION_COMMAND", {1, 2, 3}}).problem, "");
}

TEST(SessionDesk, CountsDatagramsAndObeysThemIfConfigured) {
  DeskBench b;
  SessionDesk desk(b.config, b.recorder);
  EXPECT_EQ(desk.channel(), "FRAMEWATCH_SESSION_COMMAND");
  const std::vector<std::uint8_t> start = drivers::encoded(command("start"));
  testing::internal::CaptureStderr();
  for (int i = 0; i < 1000; ++i) desk.heard(start.data(), start.size(), 5);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(desk.not_obeyed(), 1000);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_NE(said.find("set lcm.commands = true"), std::string::npos) << said;
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  b.config.lcm.commands = true;
  desk.heard(start.data(), 7, 5);
  EXPECT_EQ(b.recorder.state(), RecorderState::waiting);
  desk.heard(start.data(), start.size(), 5);
  EXPECT_EQ(b.recorder.state(), RecorderState::recording);
}

TEST(SessionDesk, EscapesAnUnknownCommand) {
  DeskBench b;
  SessionDesk desk(b.config, b.recorder);
  const auto answer = b.give(desk, {"SESSION_COMMAND", drivers::encoded(command("\x1b[2J\n"))});
  const auto status = drivers::decoded<session_status_t>(answer.bytes);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->refused, "no such command: \\x1b[2J\\n");
}

}  // namespace session_desk_test
}  // namespace framewatch::daemon
