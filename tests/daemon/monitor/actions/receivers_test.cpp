// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/receivers.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace hook_command_test {

using namespace std::chrono_literals;

// Limits.
constexpr double kLongestEnd_s = 30;  // to end a process group that ignores SIGTERM
constexpr double kShortTimeout_s = 0.4;
constexpr double kTimeToBegin_s = 10;  // a shell and its child start, on a busy machine
constexpr auto kSoon = 60s;            // for short actions on an idle machine

class Hook : public testing::Test {
 protected:
  /// Returns the settings for a shell script as the command.
  ActionSettings script(const std::string& lines, std::vector<std::string> arguments = {}) {
    test::write_file(directory_.path("hook"),
                     "#!/bin/sh\ncd " + directory_.path("") + "\n" + lines);
    std::filesystem::permissions(directory_.path("hook"), std::filesystem::perms::owner_all);
    ActionSettings settings;
    settings.command = {directory_.path("hook")};
    settings.command.insert(settings.command.end(), arguments.begin(), arguments.end());
    return settings;
  }
  static DeliveryResult run(const ActionSettings& settings) {
    const event_t e = event(7);
    return run_hook(settings, event_json(e, "a building"), event_environment(e, "a building"),
                    never);
  }
  std::string file(const std::string& name) { return test::read_file(directory_.path(name)); }

  test::TemporaryDirectory directory_;
};

TEST_F(Hook, ItsEnvironmentHasOneLineForEachVariable) {
  event_t e = event(7);
  e.place = "F1\nLD_PRELOAD=x";
  e.message = "\x1b[2Jnode \xff\n$(touch made)";
  for (const auto& [name, value] : event_environment(e, "a\nbuilding"))
    for (const char c : value) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << name;
  const auto environment = event_environment(e, "a building");
  const auto found = std::find_if(environment.begin(), environment.end(), [](const auto& variable) {
    return variable.first == "FRAMEWATCH_MESSAGE";
  });
  EXPECT_EQ(found->second, "\\x1b[2Jnode \\xff\\n$(touch made)");
  EXPECT_EQ(nlohmann::json::parse(event_json(e, "b"))["place"], "F1\nLD_PRELOAD=x");
}

TEST_F(Hook, ReceivesTheEventOnItsInputAndInItsEnvironment) {
  ::setenv("WATCHDOG_USEC", "1", 1);
  const DeliveryResult result = run(
      script("cat >input; env >environment; printf '%s' \"$1\" >argument\n", {"$(touch made); *"}));
  ::unsetenv("WATCHDOG_USEC");
  EXPECT_EQ(result.trouble, "");
  const auto json = nlohmann::json::parse(file("input"));
  EXPECT_EQ(json["schema"], "framewatch.event/1");
  EXPECT_EQ(json["state"], "raised");
  EXPECT_EQ(json["severity"], "alarm");
  EXPECT_EQ(json["id"], 7);
  EXPECT_EQ(json["value"], -5.25);
  EXPECT_TRUE(json["std_error"].is_null());
  EXPECT_EQ(json["time"], "2023-11-14T22:13:20.000Z");
  EXPECT_EQ(json["message"], event(7).message);
  EXPECT_EQ(file("argument"), "$(touch made); *");
  EXPECT_FALSE(std::filesystem::exists(directory_.path("made")));
  const std::string environment = file("environment");
  for (const char* line : {"FRAMEWATCH_KIND=stiffness_change\n", "FRAMEWATCH_STATE=raised\n",
                           "FRAMEWATCH_EVENT_ID=7\n", "FRAMEWATCH_BUILDING=a building\n", "PATH="})
    EXPECT_NE(environment.find(line), std::string::npos) << line;
  EXPECT_EQ(environment.find("WATCHDOG_USEC"), std::string::npos);
}

TEST_F(Hook, ReportsWhyItFailed) {
  EXPECT_NE(run(script("echo so; echo it is so >&2; exit 3\n"))
                .trouble.find("hook: exit status 3: it is so"),
            std::string::npos);
  EXPECT_NE(run(script("kill -9 $$\n")).trouble.find("hook: signal 9"), std::string::npos);
  ActionSettings none;
  none.command = {"/no/such/program"};
  EXPECT_EQ(run(none).trouble, "/no/such/program: No such file or directory");
  EXPECT_FALSE(run(none).retry);
}

TEST_F(Hook, IsEndedWithItsGroupWhenItTakesTooLong) {
  // The command and its child ignore SIGTERM.
  ActionSettings settings = script(
      "trap '' TERM\nsh -c 'trap \"\" TERM; echo $$ >pid; while :; do sleep 0.1; done' &\n"
      "while :; do sleep 0.1; done\n");
  settings.command_timeout_s = kTimeToBegin_s;
  DeliveryResult result;
  const double took_s = seconds_for([&] { result = run(settings); });
  EXPECT_NE(result.trouble.find("ended after 10 s"), std::string::npos) << result.trouble;
  EXPECT_LT(took_s, kTimeToBegin_s + kLongestEnd_s);
  ASSERT_NE(file("pid"), "");
  const pid_t pid = std::stoi(file("pid"));
  EXPECT_TRUE(test::comes_true(
      [&] {
        const std::string state = test::read_file("/proc/" + std::to_string(pid) + "/stat");
        return state.empty() || state.find(") Z") != std::string::npos;
      },
      kSoon));
}

TEST_F(Hook, MayIgnoreItsInputAndWriteALot) {
  ActionSettings settings = script("exec yes\n");
  settings.command_timeout_s = kShortTimeout_s;
  EXPECT_NE(run(settings).trouble.find("ended after"), std::string::npos);
  EXPECT_EQ(run(script("exec >&- 2>&-; sleep 0.3\n")).trouble, "");
}

}  // namespace hook_command_test

}  // namespace framewatch::daemon
