// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include <gtest/gtest.h>

#include "drivers/lcm/lcm_log.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {

inline constexpr int kEvents = 10;
inline constexpr std::size_t kPayload = 60;
inline constexpr std::size_t kEventBytes = 28 + 5 + kPayload;

inline std::string payload(int event) {
  std::string bytes(kPayload, static_cast<char>('a' + event));
  return bytes;
}

/// Returns a log of ten events on channel ACCEL with timestamps 1000, 2000, ...
inline std::string ten_events() {
  const test::TemporaryDirectory directory;
  LcmLogWriter writer;
  EXPECT_TRUE(writer.open(directory.path("log")));
  for (int i = 0; i < kEvents; ++i)
    EXPECT_TRUE(writer.write(1000 * (i + 1), "ACCEL", payload(i).data(), kPayload));
  EXPECT_TRUE(writer.close());
  return test::read_file(directory.path("log"));
}

}  // namespace framewatch::drivers
