// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "drivers/lcm/lcm_log.h"
#include "tests/drivers/lcm/ten_events.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace lcm_log_writer_test {

using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

TEST(LcmLogWriter, WritesTheBytesTheLcmLibraryWrites) {
  const TemporaryDirectory directory;
  lcm::LogFile theirs(directory.path("theirs"), "w");
  ASSERT_TRUE(theirs.good());
  for (int i = 0; i < kEvents; ++i) {
    std::string data = payload(i);
    lcm::LogEvent event{};
    event.timestamp = 1000 * (i + 1);
    event.channel = "ACCEL";
    event.datalen = static_cast<std::int32_t>(data.size());
    event.data = data.data();
    ASSERT_EQ(theirs.writeEvent(&event), 0);
  }
  std::fflush(theirs.getFilePtr());
  EXPECT_EQ(ten_events(), read_file(directory.path("theirs")));
}

TEST(LcmLogWriter, LcmLogplayerPlaysIt) {
  if (std::system("command -v lcm-logplayer >/dev/null") != 0)
    GTEST_SKIP() << "lcm-logplayer (package liblcm-bin) is not installed";
  const TemporaryDirectory directory;
  write_file(directory.path("ours"), ten_events());
  const std::string command = "lcm-logplayer -s 100 --lcm='file://" + directory.path("played") +
                              "?mode=w' " + directory.path("ours") + " >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  LcmLogReader reader;
  ASSERT_TRUE(reader.open(directory.path("played")));
  LogEvent event;
  for (int i = 0; i < kEvents; ++i) {
    ASSERT_EQ(reader.next(event), LogRead::event);
    EXPECT_EQ(event.channel, "ACCEL");
    EXPECT_EQ(std::string(event.data.begin(), event.data.end()), payload(i));
  }
  EXPECT_EQ(reader.next(event), LogRead::end);
}

TEST(LcmLogWriter, CreatesItsFileOnlyWhenClosed) {
  const TemporaryDirectory directory;
  {
    LcmLogWriter writer;
    ASSERT_TRUE(writer.open(directory.path("log")));
    ASSERT_TRUE(writer.write(0, "ACCEL", "x", 1));
    EXPECT_EQ(directory.names(), std::vector<std::string>{"log.partial"});
  }
  EXPECT_TRUE(directory.names().empty());
}

TEST(LcmLogWriter, RefusesEventsThatNoReaderAccepts) {
  const TemporaryDirectory directory;
  LcmLogWriter writer;
  EXPECT_FALSE(writer.open(directory.path("no/such/directory")));
  EXPECT_EQ(writer.error(), "No such file or directory");
  ASSERT_TRUE(writer.open(directory.path("log")));
  EXPECT_FALSE(writer.write(0, std::string(64, 'A'), "x", 1));
  EXPECT_FALSE(writer.close());
  EXPECT_TRUE(directory.names().empty());
}

TEST(LcmLogWriter, ReportsAFullDisk) {
  LcmLogWriter writer;
  const TemporaryDirectory directory;
  ASSERT_TRUE(writer.open(directory.path("log")));
  const std::string data(1 << 19, 'x');
  {
    const test::FullDisk full(1000);
    EXPECT_FALSE(writer.write(0, "ACCEL", data.data(), data.size()) && writer.close());
  }
  EXPECT_EQ(writer.error(), "File too large");
  EXPECT_FALSE(writer.close());
  EXPECT_TRUE(directory.names().empty());
}

TEST(LcmLogWriter, WritesNoFileThroughALink) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink(directory.path("victim"), directory.path("log.partial"));
  LcmLogWriter writer;
  EXPECT_FALSE(writer.open(directory.path("log")));
  EXPECT_NE(writer.error().find("symbolic link"), std::string::npos) << writer.error();
  EXPECT_FALSE(std::filesystem::exists(directory.path("victim")));
}

}  // namespace lcm_log_writer_test
}  // namespace framewatch::drivers
