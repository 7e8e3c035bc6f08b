// SPDX-License-Identifier: MIT
#include "daemon/base/miniseed_file.h"

#include <gtest/gtest.h>

#include "drivers/formats/record_file.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace miniseed_file_test {

TEST(MiniseedFile, KeepsTimesToTheMicrosecond) {
  constexpr std::int64_t kStart_us = 1'795'478'400'123'457;
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("a.mseed");
  MiniseedFile file({seed_channel("XX", "TEST", 0, 200)}, 200);
  ASSERT_TRUE(file.open(path)) << file.error();
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(file.put(0, kStart_us + i * 5'000, i % 17));
  ASSERT_TRUE(file.close()) << file.error();
  drivers::RecordOptions options;
  options.unit_mps2 = 0.5;
  std::vector<drivers::Problem> problems;
  const auto record = drivers::read_record(path, options, problems);
  ASSERT_TRUE(record) << problems.front().message;
  EXPECT_EQ(record->names, std::vector<std::string>{"XX.TEST.01.HN1"});
  ASSERT_EQ(record->time_s.size(), 1000U);
  for (int i = 0; i < 1000; ++i) {
    const auto at = static_cast<std::size_t>(i);
    ASSERT_EQ(record->time_s[at], static_cast<double>(kStart_us + i * 5'000) / 1e6);
    ASSERT_EQ(record->accel_mps2[0][at], 0.5 * (i % 17));
  }
}

}  // namespace miniseed_file_test
}  // namespace framewatch::daemon
