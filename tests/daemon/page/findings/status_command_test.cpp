// SPDX-License-Identifier: MIT
#include "daemon/page/findings/status_command.h"

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/service_t.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/events/event_messages.h"
#include "tests/support/recorded_table_test.h"

namespace framewatch::daemon {
namespace status_command_test {

using namespace std::chrono_literals;

/// Returns a daemon's report that any process on the bus may have sent.
service_t forged() {
  service_t s{};
  s.time_us = s.started_us = host_clock_us();
  s.config = "/etc/\x1b]0;owned\x07";
  s.version = "1\x1b[2J";
  s.raised = 1;
  s.event_id = {7};
  s.event_since_us = {1};
  s.event_severity = {severity::alarm};
  s.event_kind = {"gap"};
  s.event_place = {"F1\xff"};
  s.event_message = {"they differ\n  systemd     active (running)\x1b[31m"};
  return s;
}

TEST(Status, PrintsNoForeignBytesToTheTerminal) {
  if (const char* reason = std::getenv("FRAMEWATCH_NO_MULTICAST")) GTEST_SKIP() << reason;
  std::atomic<bool> stop = false;
  std::thread sender([&] {
    lcm::LCM bus("udpm://239.255.76.67:7667?ttl=0");
    while (!stop) {
      const service_t s = forged();
      acknowledged_t known{};
      bus.publish("FRAMEWATCH_SERVICE", &s);
      bus.publish("FRAMEWATCH_ACKNOWLEDGED", &known);
      std::this_thread::sleep_for(100ms);
    }
  });
  for (const bool json : {false, true}) {
    StatusArguments arguments;
    arguments.config = test::table_config();
    arguments.json = json;
    testing::internal::CaptureStdout();
    EXPECT_EQ(status_command(arguments), 1);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_NE(text.find("The model does not fit: they differ\\n  systemd     active"),
              std::string::npos)
        << text;
    EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](unsigned char c) {
      return (c < 0x20 && c != '\n') || c > 0x7e;
    })) << text;
  }
  stop = true;
  sender.join();
}

}  // namespace status_command_test
}  // namespace framewatch::daemon
