// SPDX-License-Identifier: MIT
#include <framewatch/service_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/monitor/service/health.h"

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/monitor/service/service_manager.h"
#include "daemon/page/findings/status_command.h"
#include "daemon/tools/commands/selftest_command.h"
#include "drivers/lcm/lcm_source.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace health_test {

constexpr std::int64_t kNow_us = 1'000'000 * kSecond_us;

/// Two reports, one second apart, of a healthy daemon.
Heard well(const Config& config) {
  service_t s{};
  s.started_us = kNow_us - 3600 * kSecond_us;
  s.time_us = kNow_us - kSecond_us;
  s.received_us = s.time_us;
  s.version = FRAMEWATCH_VERSION;
  s.config_sha256 = config.sha256;
  s.starts = 5;
  s.unclean_starts = 2;
  s.disk_free_bytes = 50'000'000'000;
  s.name = {"base", "F1"};
  s.newest_us = {10 * kSecond_us, 10 * kSecond_us};
  s.latencies = {100, 0};
  status_t status{};
  status.name = s.name;
  status.received = {100, 100};
  status.lost = {3, 3};
  status.rejected = {0, 0};
  status.time_us = 9 * kSecond_us;
  Heard heard(config);
  heard.first_service = s;
  heard.first_status = status;
  s.latencies = {200, 0};
  s.received_us = kNow_us;
  status.received = {200, 200};
  status.time_us = 10 * kSecond_us;
  heard.service = s;
  heard.status = status;
  return heard;
}

/// Returns the only oddity.
std::string odd(const Heard& heard, const Config& config, std::int64_t now_us = kNow_us) {
  const std::vector<std::string> found =
      oddities(heard, config, now_us, [](const event_t& e) { return e.message; });
  return found.size() == 1 ? found.front() : std::to_string(found.size()) + " oddities";
}

TEST(Health, ReportsNoProblemOfAHealthyDaemon) {
  const Config config{};
  EXPECT_EQ(odd(well(config), config), "0 oddities");
}

TEST(Health, NamesABrokerThatIsAwayOrRefusesATopic) {
  const Config config{};
  Heard heard = well(config);
  heard.mqtt.emplace();
  heard.mqtt->broker = "mqtt://b";
  EXPECT_EQ(odd(heard, config), "0 oddities");  // it is still connecting
  heard.mqtt->trouble = "Connection refused";
  heard.mqtt->time_us = kNow_us;
  heard.mqtt->since_us = kNow_us - 300 * kSecond_us;
  EXPECT_EQ(
      odd(heard, config),
      "no connection to mqtt://b for 5 min 0 s: Connection refused. Its readings are missing");
  heard.mqtt->connected = 1;
  heard.mqtt->trouble = "the broker refuses the topic t";
  EXPECT_EQ(
      odd(heard, config),
      "mqtt://b: the broker refuses the topic t. Its readings are missing: check the broker's "
      "access rules");
}

TEST(Health, ReportsASilentThermometer) {
  Config config{};
  config.watch.emplace();
  Heard h = well(config);
  h.watch.emplace();
  h.watch->temperature_degc = std::nan("");
  EXPECT_EQ(odd(h, config), "0 oddities");
  config.watch->temperature_channel = "ROOF";
  EXPECT_EQ(odd(h, config), "no temperature on ROOF");
  h.watch->temperature_degc = 4;
  EXPECT_EQ(odd(h, config), "0 oddities");
}

TEST(Health, ReportsASilentHub) {
  Config config{};
  Heard h = well(config);
  EXPECT_EQ(odd(h, config), "0 oddities");
  config.fleet.emplace();
  EXPECT_EQ(odd(h, config),
            "framewatch uplink does not report: systemctl status framewatch-uplink");
  h.uplink.emplace();
  h.uplink->started_us = kNow_us - 8 * 3600 * kSecond_us;
  h.uplink->acknowledged_us = kNow_us - 3500 * kSecond_us;
  EXPECT_EQ(odd(h, config), "0 oddities");
  h.uplink->connected = 1;  // the connection alone proves nothing
  h.uplink->acknowledged_us = kNow_us - 3 * 3600 * kSecond_us;
  EXPECT_EQ(odd(h, config), "the hub has acknowledged nothing for 3 h 0 min");
  h.uplink->started_us = kNow_us - 60 * kSecond_us;
  EXPECT_EQ(odd(h, config), "0 oddities");
  h.uplink->store_trouble = "disk I/O error";
  EXPECT_EQ(odd(h, config),
            "the messages that wait for the hub cannot be read or written: disk I/O error");
}

/// The other channels were called silent for ten years.
TEST(Health, NamesTheChannelWhoseClockIsApart) {
  constexpr std::int64_t kTenYears_us = 3652 * kDay_us;
  const Config config{};
  Heard h = well(config);
  h.service->name = h.first_service->name = {"base", "F1", "F2", "F3"};
  const std::int64_t now_us = 10 * kSecond_us;
  h.first_service->newest_us = {now_us, now_us, now_us, now_us};
  h.service->newest_us.assign(4, now_us + kSecond_us);
  h.service->newest_us[2] += kTenYears_us;
  EXPECT_EQ(odd(h, config), "F2: its clock is 3652 d 0 h ahead of the others");
  h.first_service->newest_us[2] -= kTenYears_us;
  h.service->newest_us[2] -= 2 * kTenYears_us;
  h.first_service->newest_us[2] -= kTenYears_us;
  EXPECT_EQ(odd(h, config), "F2: its clock is 3652 d 0 h behind the others");
  h.service->newest_us = {now_us, now_us, now_us, now_us + 7 * kSecond_us};
  h.first_service->newest_us = {now_us, now_us, now_us, now_us + 6 * kSecond_us};
  const auto found = oddities(h, config, kNow_us, [](const event_t& e) { return e.message; });
  EXPECT_EQ(found, std::vector<std::string>(
                       {"base: silent for 7 s", "F1: silent for 7 s", "F2: silent for 7 s"}))
      << "only F3 sends";
}

TEST(Health, ReportsProblems) {
  const Config config{};
  Heard h = well(config);
  EXPECT_EQ(odd(h, config, kNow_us + 70 * kSecond_us), "no samples for 1 min 10 s");
  h.service->newest_us[1] = 3 * kSecond_us;
  EXPECT_EQ(odd(h, config), "F1: silent for 7 s");
  h.service->newest_us[1] = 0;
  EXPECT_EQ(odd(h, config), "F1: no samples yet");
  h = well(config);
  h.status->lost[0] = 4;
  EXPECT_EQ(odd(h, config), "base: loses 1.0 % of its samples");
  h = well(config);
  h.status->rejected[1] = 2;
  EXPECT_EQ(odd(h, config), "F1: 2 of its samples were rejected");
  h = well(config);
  h.service->deadline_missed = 30;
  EXPECT_EQ(odd(h, config), "30 % of the estimates come late");
  h = well(config);
  h.service->started_us = kNow_us - 30 * kSecond_us;
  EXPECT_EQ(odd(h, config).substr(0, 24), "it started 30 s ago; 2 o");
  h.service->unclean_starts = 0;
  EXPECT_EQ(odd(h, config), "0 oddities");
  h = well(config);
  h.service->config_sha256 = "other";
  EXPECT_NE(odd(h, config).find("reload"), std::string::npos);
  h.service->reload_problem = "b.toml:3: bad";
  EXPECT_NE(odd(h, config).find("configuration was refused: b.toml:3: bad"), std::string::npos);
  h = well(config);
  h.service->version = "0.0.9";
  EXPECT_NE(odd(h, config).find("restart"), std::string::npos);
  h = well(config);
  h.service->state_problem = "No space left on device";
  EXPECT_NE(odd(h, config).find("No space left on device"), std::string::npos);
  h = well(config);
  h.service->disk_free_bytes = 200'000'000;
  EXPECT_EQ(odd(h, config), "0.2 GB are free on the disk of its state file");
  h = well(config);
  h.history.emplace();
  EXPECT_EQ(odd(h, config), "0 oddities");
  h.history->raw_trouble = "No space left on device";
  EXPECT_EQ(odd(h, config), "raw samples are not stored: No space left on device");
  h = well(config);
  h.actions.emplace();
  h.actions->name = {"webhook"};
  h.actions->time_us = kNow_us;
  h.actions->lost = {3};
  h.actions->lost_us = {kNow_us - 70 * kSecond_us};
  h.actions->trouble = {"the server answers 500"};
  EXPECT_EQ(odd(h, config), "webhook notifications of [actions] fail: the server answers 500");
  h.actions->trouble = {""};
  EXPECT_EQ(odd(h, config),
            "the webhook of [actions] has lost 3 events, the last one 1 min 10 s ago");
  h.actions->time_us += 86'400 * kSecond_us;
  EXPECT_EQ(odd(h, config), "0 oddities");
  h = well(config);
  h.can.emplace();
  h.can->interface = {"can0", "can1"};
  h.can->state = {0, 3};
  EXPECT_EQ(odd(h, config), "CAN bus can1 is bus-off");
  h = well(config);
  h.service->event_id = {1, 2};
  h.service->event_since_us = {1, 2};
  h.service->event_severity = {0, 2};
  h.service->event_kind = {"gap", "stiffness_change"};
  h.service->event_place = {"F1", "kx_1_y1"};
  h.service->event_message = {"agree", "is less"};
  EXPECT_EQ(odd(h, config), "is less (stiffness_change, event 2)");
  h.acknowledged.emplace();
  h.acknowledged->id = {1};
  EXPECT_EQ(odd(h, config), "is less (stiffness_change, event 2)");
  h.acknowledged->id = {1, 2};
  EXPECT_EQ(odd(h, config), "0 oddities");
}

TEST(Health, PrintsReadableDurations) {
  EXPECT_EQ(span_text(2.9), "2 s");
  EXPECT_EQ(span_text(310), "5 min 10 s");
  EXPECT_EQ(span_text(7260), "2 h 1 min");
  EXPECT_EQ(span_text(273600), "3 d 4 h");
}

TEST(StatusCommand, DistinguishesHealthyTroubledAndMissingDaemons) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::string error;
  if (!drivers::open_lcm(LcmSettings{}.url, {}, error)) GTEST_SKIP() << error;
  testing::internal::CaptureStderr();
  EXPECT_EQ(status_command({test::table_config(), "", false}), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("nothing is heard"), std::string::npos);

  test::Child daemon({FRAMEWATCH_PROGRAM, "run", test::table_config(), "--quiet"});
  {
    test::Child table({FRAMEWATCH_PROGRAM, "simulate",
                       FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", "--lcm",
                       "--seconds", "60", "--quiet"});
    ::usleep(2'000'000);
    testing::internal::CaptureStdout();
    const int code = status_command({test::table_config(), "", true});
    const auto told = nlohmann::json::parse(testing::internal::GetCapturedStdout());
    EXPECT_EQ(code, told["well"] ? 0 : 1);
    for (const std::string sentence : told["odd"])  // only lateness is possible, on a busy machine
      EXPECT_NE(sentence.find("late"), std::string::npos) << sentence;
    EXPECT_EQ(told["version"], FRAMEWATCH_VERSION);
    EXPECT_LT(told["silent_s"], 1.0);
  }
  ::usleep(6'000'000);
  testing::internal::CaptureStdout();
  EXPECT_EQ(status_command({test::table_config(), "", false}), 1);
  const std::string screen = testing::internal::GetCapturedStdout();
  EXPECT_NE(screen.find("two-story table model: not well"), std::string::npos) << screen;
  EXPECT_NE(screen.find("no samples for"), std::string::npos) << screen;
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
}

TEST(StatusCommand, NamesTheConfigurationInUseIfTheFileChangedOrIsWrong) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::string error;
  if (!drivers::open_lcm(LcmSettings{}.url, {}, error)) GTEST_SKIP() << error;
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("table.toml");
  const std::string text = test::read_file(test::table_config());
  test::write_file(path, text);
  test::Child daemon({FRAMEWATCH_PROGRAM, "run", path, "--quiet"});
  const auto screen = [&](const std::string& now) {
    test::write_file(path, now);
    testing::internal::CaptureStdout();
    const int code = status_command({path, "", false});
    std::string out = testing::internal::GetCapturedStdout();
    EXPECT_EQ(code, now == text && out.find("not well") == std::string::npos ? 0 : 1);
    return out;
  };
  const std::string sha = "sha256 " + sha256(text).substr(0, 12);
  const std::string same = screen(text);
  EXPECT_NE(same.find(sha + ", as it is on the disk"), std::string::npos) << same;
  const std::string other = screen(text + "\n# another one\n");
  EXPECT_NE(other.find(sha + "; " + path + " is another one now"), std::string::npos) << other;
  EXPECT_NE(other.find("reload framewatch"), std::string::npos) << other;
  const std::string wrong = screen(text + "\n[wach]\n");
  EXPECT_NE(wrong.find("its configuration file is wrong now"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("did you mean watch"), std::string::npos) << wrong;
  EXPECT_EQ(wrong.find("reload framewatch"), std::string::npos) << wrong;
  EXPECT_NE(screen("").find("its configuration file is wrong now"), std::string::npos);
  EXPECT_EQ(daemon.stop(SIGTERM), 0);
}

TEST(UnitState, DescribesTheSystemdState) {
  EXPECT_EQ(unit_text({"active", "running", "success", 0}), "active (running)");
  EXPECT_EQ(unit_oddity({"active", "running", "success", 3}), "");
  const UnitState gone{"failed", "failed", "start-limit-hit", 15};
  EXPECT_EQ(unit_text(gone),
            "failed (failed), the last result was start-limit-hit, restarted 15 times by systemd "
            "since somebody started it");
  EXPECT_NE(unit_oddity(gone).find("reset-failed"), std::string::npos);
  EXPECT_NE(unit_oddity({"activating", "auto-restart", "watchdog", 2}).find("2 times"),
            std::string::npos);
  EXPECT_NE(unit_oddity({"failed", "failed", "exit-code", 0}).find("exit-code"), std::string::npos);
}

TEST(Selftest, FindsTheKnownAnswer) {
  const MachineCheck check = check_estimate();
  EXPECT_EQ(check.name, "estimate");
  EXPECT_EQ(check.found.substr(0, 8), "8 frames") << check.found;
  EXPECT_EQ(check.remedy.find("wrongly"), std::string::npos) << check.found;
}

TEST(Selftest, GivesAdviceForEveryFailure) {
  const test::TemporaryDirectory directory;
  EXPECT_TRUE(check_disk(directory.path("")).found.find("GB free") != std::string::npos);
  EXPECT_TRUE(directory.names().empty());
  const MachineCheck nowhere = check_disk("/nowhere");
  EXPECT_FALSE(nowhere.good);
  EXPECT_NE(nowhere.remedy.find("No such file or directory"), std::string::npos);
  LcmSettings greedy;
  greedy.reception.receive_buffer_bytes = 1 << 30;
  const MachineCheck buffer = check_buffer(greedy);
  EXPECT_FALSE(buffer.good);
  EXPECT_NE(buffer.remedy.find("net.core.rmem_max=1073741824"), std::string::npos);
  LcmSettings none;
  none.url = "udpm://10.0.0.1:7667";
  EXPECT_FALSE(check_multicast(none).good);
  EXPECT_NE(check_multicast(none).remedy.find("expected a multicast address"), std::string::npos);
}

}  // namespace health_test
}  // namespace framewatch::daemon
