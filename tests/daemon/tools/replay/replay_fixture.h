// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/replay/replay_command.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::test {

struct ReplayOutcome {
  int exit_code;
  std::string out, err;
};

inline ReplayOutcome replay_of(std::vector<std::string> inputs, const std::string& out = "",
                               bool json = false, const std::string& config = table_config()) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = daemon::replay({config, std::move(inputs), out, false, false, json});
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

/// Runs replay --salvage on one log.
inline ReplayOutcome salvage_of(const std::string& input, const std::string& out) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const int code = daemon::replay({table_config(), {input}, out, true, false, false});
  return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
}

inline std::vector<drivers::LogEvent> events_of(const std::string& path) {
  drivers::LcmLogReader reader;
  EXPECT_TRUE(reader.open(path));
  std::vector<drivers::LogEvent> events;
  drivers::LogEvent event;
  while (reader.next(event) == drivers::LogRead::event) events.push_back(event);
  return events;
}

/// Returns the payloads of the events of a channel.
inline std::vector<std::vector<std::uint8_t>> payloads(const std::string& path,
                                                       const std::string& channel) {
  std::vector<std::vector<std::uint8_t>> found;
  for (const drivers::LogEvent& event : events_of(path))
    if (event.channel == channel) found.push_back(event.data);
  return found;
}

/// Writes a copy of the log with every event changed or, if `change` returns false, left out.
template <typename Change>
void rewrite(const std::string& from, const std::string& to, Change change) {
  drivers::LcmLogWriter writer;
  ASSERT_TRUE(writer.open(to));
  for (drivers::LogEvent event : events_of(from)) {
    if (!change(event)) continue;
    ASSERT_TRUE(
        writer.write(event.timestamp_us, event.channel, event.data.data(), event.data.size()));
  }
  ASSERT_TRUE(writer.close());
}

/// Replays of a simulated test that is recorded once as a log and as a record.
class ReplayFixture : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    directory_ = new TemporaryDirectory;
    record_table_test(directory_->path("rec.lcmlog"));
    record_table_test(directory_->path("rec.csv"));
  }
  static void TearDownTestSuite() { delete directory_; }

  static std::string log() { return directory_->path("rec.lcmlog"); }
  static std::string csv() { return directory_->path("rec.csv"); }
  std::string path(const std::string& name) const { return own_.path(name); }

  /// Returns only the files of the test itself.
  void expect_refused(const std::string& input, const std::string& rule) {
    const ReplayOutcome o = replay_of({input}, path("est.lcmlog"));
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_NE(o.err.find(rule), std::string::npos) << o.err;
    EXPECT_NE(o.err.find(input), std::string::npos) << o.err;
    EXPECT_TRUE(o.out.empty());
    for (const std::string& name : own_.names()) EXPECT_EQ(name.find("est"), std::string::npos);
  }

  TemporaryDirectory own_;

 private:
  inline static TemporaryDirectory* directory_ = nullptr;
};

}  // namespace framewatch::test
