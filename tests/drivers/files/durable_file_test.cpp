// SPDX-License-Identifier: MIT
#include "drivers/files/durable_file.h"

#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/full_disk.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace durable_file_test {

using namespace std::chrono_literals;

// Limits.
constexpr auto kSoon = 60s;         // for actions that take a quarter of a second
constexpr auto kPastSync = 2500ms;  // the file is forced onto the disk every second

template <typename Condition>
bool comes_true(Condition condition) {
  for (const auto until = std::chrono::steady_clock::now() + kSoon;
       std::chrono::steady_clock::now() < until; std::this_thread::sleep_for(10ms))
    if (condition()) return true;
  return condition();
}

TEST(DurableFile, WritesAppendedBytesBeforeClose) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("log");
  std::string error, expected;
  DurableFile file;
  ASSERT_TRUE(file.open(path, error)) << error;
  for (int i = 0; i < 1000; ++i) {
    const std::string line = "line " + std::to_string(i) + "\n";
    EXPECT_TRUE(file.append(line));
    expected += line;
  }
  EXPECT_TRUE(comes_true([&] { return test::read_file(path + ".partial") == expected; }));
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_TRUE(DurableFile::in_use(path));
  EXPECT_TRUE(file.close(error)) << error;
  EXPECT_EQ(test::read_file(path), expected);
  EXPECT_FALSE(DurableFile::in_use(path));
  EXPECT_EQ(directory.names(), std::vector<std::string>{"log"});
}

TEST(DurableFile, AFullDiskDelaysWritesButTearsNone) {
  const test::TemporaryDirectory directory;
  std::string error, expected;
  DurableFile file;
  ASSERT_TRUE(file.open(directory.path("log"), error)) << error;
  {
    const test::FullDisk full(1000);
    for (int i = 0; i < 300; ++i) {
      expected += "0123456789";
      EXPECT_TRUE(file.append("0123456789"));
    }
    EXPECT_TRUE(comes_true([&] { return !file.trouble().empty(); }));
    EXPECT_EQ(file.counters().bytes, 1000);
  }
  EXPECT_TRUE(comes_true([&] { return file.trouble().empty(); })) << file.trouble();
  EXPECT_TRUE(file.append("end"));
  EXPECT_TRUE(file.close(error)) << error;
  EXPECT_EQ(test::read_file(directory.path("log")), expected + "end");
  EXPECT_EQ(file.counters().dropped, 0);
}

TEST(DurableFile, CountsDroppedBytesAndKeepsWrittenOnes) {
  const test::TemporaryDirectory directory;
  std::string error;
  DurableFile file(100);
  ASSERT_TRUE(file.open(directory.path("log"), error)) << error;
  const test::FullDisk full(30);
  int taken = 0;
  for (int i = 0; i < 50; ++i) taken += file.append("0123456789");
  EXPECT_TRUE(comes_true([&] { return !file.trouble().empty(); }));
  EXPECT_LE(taken, 13);
  EXPECT_EQ(file.counters().appended, taken);
  EXPECT_EQ(file.counters().dropped, 50 - taken);
  EXPECT_LE(file.counters().queue_high_water, 100u);
  EXPECT_FALSE(file.close(error, 50ms));
  EXPECT_NE(error.find("log.partial"), std::string::npos) << error;
  EXPECT_EQ(directory.names(), std::vector<std::string>{"log.partial"});
  EXPECT_EQ(test::read_file(directory.path("log.partial")), "012345678901234567890123456789");
}

TEST(DurableFile, NeverOverwritesAFile) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("log.partial"), "of a crash");
  std::string error;
  DurableFile file;
  EXPECT_FALSE(file.open(directory.path("log"), error));
  EXPECT_NE(error.find("log.partial"), std::string::npos);
  EXPECT_FALSE(DurableFile().open(directory.path("no/such"), error));
  EXPECT_EQ(test::read_file(directory.path("log.partial")), "of a crash");
}

TEST(DurableFile, IsCreatedOnTheFirstWriteThatSucceeds) {
  const test::TemporaryDirectory directory;
  const std::string folder = directory.path("not there yet"), path = folder + "/log";
  DurableFile file;
  file.open_when_needed([&] { return path; });
  EXPECT_TRUE(file.append("kept"));
  EXPECT_TRUE(comes_true([&] { return !file.trouble().empty(); }));
  EXPECT_EQ(file.counters().queued, 4u);
  std::filesystem::create_directory(folder);
  EXPECT_TRUE(comes_true([&] { return test::read_file(path + ".partial") == "kept"; }));
  EXPECT_EQ(file.trouble(), "");
  std::string error;
  EXPECT_TRUE(file.close(error)) << error;
  EXPECT_EQ(test::read_file(path), "kept");
}

TEST(DurableFile, ReportsWhyItCannotBeCreated) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("none/log");
  DurableFile file;
  file.open_when_needed([&] { return path; });
  EXPECT_TRUE(file.append("waits"));
  ASSERT_TRUE(comes_true([&] { return !file.trouble().empty(); }));
  for (const auto until = std::chrono::steady_clock::now() + kPastSync;
       std::chrono::steady_clock::now() < until; std::this_thread::sleep_for(10ms))
    ASSERT_NE(file.trouble().find("none/log.partial: No such file"), std::string::npos)
        << file.trouble();
  std::string error;
  EXPECT_FALSE(file.close(error, 0ms));
  EXPECT_NE(error.find("No such file"), std::string::npos) << error;
}

TEST(DurableFile, KnowsThatItWasRemovedOrReplaced) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("log"), partial = path + ".partial";
  for (const bool replaced : {false, true}) {
    std::string error;
    DurableFile file;
    ASSERT_TRUE(file.open(path, error)) << error;
    EXPECT_TRUE(file.append("kept"));
    EXPECT_FALSE(file.is_lost());
    std::filesystem::remove(partial);
    if (replaced) test::write_file(partial, "another one");
    EXPECT_TRUE(comes_true([&] { return file.is_lost(); }));
    std::filesystem::remove(partial);
    EXPECT_FALSE(file.close(error));
    EXPECT_NE(error.find("log.partial"), std::string::npos) << error;
  }
}

TEST(DurableFile, IsNotCreatedWithoutAWrite) {
  const test::TemporaryDirectory directory;
  DurableFile file;
  file.open_when_needed([&] { return directory.path("log"); });
  std::string error;
  EXPECT_TRUE(file.close(error)) << error;
  EXPECT_TRUE(directory.names().empty());
}

}  // namespace durable_file_test
}  // namespace framewatch::drivers
