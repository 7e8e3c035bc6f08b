// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/session/recorder.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::test {

/// Returns the configuration of the simulated table.
inline daemon::Config table_configuration() {
  std::vector<daemon::ConfigProblem> problems;
  auto config = daemon::load_config(table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  return *config;
}

/// A recorder without LCM; messages set its time.
struct RecorderBench {
  TemporaryDirectory directory;
  daemon::Config config = table_configuration();
  std::vector<std::string> ended;
  daemon::Recorder recorder{config, directory.path("sessions"),
                            [this](const std::string& folder) { ended.push_back(folder); }};

  /// Moves the base channels at a level from `from_s` to `to_s`; other channels rest.
  void play(double from_s, double to_s, const std::function<double(double)>& base) {
    for (auto i = std::llround(100 * from_s); i < std::llround(100 * to_s); ++i) {
      const double t = 0.01 * static_cast<double>(i);
      for (std::int32_t node = 0; node < 10; ++node) {
        const double value = node < 2 ? base(t) : 1e-3 * std::sin(40 * t + node);
        const auto bytes = drivers::encode_accel(
            {estimator::from_microseconds(10'000 * i), i, node, {value, value, NAN}});
        recorder.message("ACCEL", bytes.data(), bytes.size(), 10'000 * i + 500);
      }
      recorder.tick(10'000 * i + 600);
    }
  }
};

/// Returns the sensor times of all samples of a log.
inline std::vector<std::int64_t> times_of(const std::string& log) {
  std::vector<std::int64_t> out;
  drivers::LcmLogReader reader;
  drivers::LogEvent event;
  if (!reader.open(log)) {
    ADD_FAILURE() << reader.error();
    return out;
  }
  std::int64_t number = 0;
  for (auto read = reader.next(event);
       read != drivers::LogRead::end && read != drivers::LogRead::error;
       read = reader.next(event)) {
    if (read != drivers::LogRead::event) continue;
    EXPECT_EQ(event.number, number++);
    if (const auto t = drivers::accel_time_us(event.data.data(), event.data.size()))
      out.push_back(*t);
  }
  return out;
}

}  // namespace framewatch::test
