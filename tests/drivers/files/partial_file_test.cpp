// SPDX-License-Identifier: MIT
#include "drivers/files/partial_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "drivers/files/durable_file.h"
#include "drivers/files/packed_file.h"
#include "drivers/files/text_output.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace partial_file_test {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

const std::string kVictim = "what an attacker wants to be overwritten";

bool write_to(PartialFile& file, const std::string& text) {
  return ::write(file.descriptor(), text.data(), text.size()) == static_cast<ssize_t>(text.size());
}

TEST(PartialFile, GetsItsNameWhenComplete) {
  const test::TemporaryDirectory directory;
  PartialFile file;
  ASSERT_TRUE(file.open(directory.path("x"))) << file.error();
  ASSERT_TRUE(write_to(file, "whole"));
  EXPECT_EQ(directory.names(), Names{"x.partial"});
  ASSERT_TRUE(file.commit()) << file.error();
  EXPECT_EQ(directory.names(), Names{"x"});
  EXPECT_EQ(test::read_file(directory.path("x")), "whole");
  EXPECT_FALSE(file.is_open());
}

TEST(PartialFile, LeavesNoFileIfNotClosed) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("x"), "before");
  {
    PartialFile file;
    ASSERT_TRUE(file.open(directory.path("x")));
    ASSERT_TRUE(write_to(file, "half"));
  }
  EXPECT_EQ(directory.names(), Names{"x"});
  EXPECT_EQ(test::read_file(directory.path("x")), "before");
}

TEST(PartialFile, IsNeverWrittenThroughALink) {
  const test::TemporaryDirectory directory;
  const std::string victim = directory.path("victim");
  test::write_file(victim, kVictim);
  fs::create_symlink(victim, directory.path("x.partial"));
  PartialFile file;
  EXPECT_FALSE(file.open(directory.path("x")));
  EXPECT_NE(file.error().find("x.partial is a symbolic link"), std::string::npos) << file.error();
  std::string why = write_text_file(directory.path("x"), "text");
  EXPECT_NE(why.find("symbolic link"), std::string::npos) << why;
  test::write_file(directory.path("from"), "packed");
  const std::atomic<bool> stop = false;
  why = pack_zstd(directory.path("from"), directory.path("x"), stop);
  EXPECT_NE(why.find("symbolic link"), std::string::npos) << why;
  DurableFile durable;
  EXPECT_FALSE(durable.open(directory.path("x"), why));
  EXPECT_EQ(test::read_file(victim), kVictim);
}

TEST(PartialFile, ReplacesTheLeftoverOfAKilledProgram) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("x.partial"), "left behind, and longer than what comes");
  fs::create_hard_link(directory.path("x.partial"), directory.path("other name"));
  EXPECT_EQ(write_text_file(directory.path("x"), "new"), "");
  EXPECT_EQ(test::read_file(directory.path("x")), "new");
  EXPECT_EQ(test::read_file(directory.path("other name")),
            "left behind, and longer than what comes");
  EXPECT_EQ(directory.names(), (Names{"other name", "x"}));
}

TEST(PartialFile, KeepsTheLeftoverOfAKilledProgramOnRequest) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("x");
  EXPECT_EQ(keep_cut_off(path), "");
  for (const std::string name : {"x.cut-off-1", "x.cut-off-2"}) {
    test::write_file(directory.path("x.partial"), name);
    EXPECT_EQ(keep_cut_off(path), directory.path(name));
  }
  PartialFile file;
  ASSERT_TRUE(file.open(path)) << file.error();
  ASSERT_TRUE(write_to(file, "being written"));
  EXPECT_EQ(keep_cut_off(path), "");
  ASSERT_TRUE(file.commit()) << file.error();
  EXPECT_EQ(directory.names(), (Names{"x", "x.cut-off-1", "x.cut-off-2"}));
  EXPECT_EQ(test::read_file(directory.path("x.cut-off-1")), "x.cut-off-1");
  fs::create_symlink("elsewhere", directory.path("x.partial"));
  EXPECT_EQ(keep_cut_off(path), "");
}

TEST(PartialFile, LeavesAFileThatIsBeingWritten) {
  const test::TemporaryDirectory directory;
  PartialFile first, second;
  ASSERT_TRUE(first.open(directory.path("x")));
  EXPECT_FALSE(second.open(directory.path("x")));
  EXPECT_NE(second.error().find("is being written"), std::string::npos) << second.error();
  ASSERT_TRUE(write_to(first, "first"));
  EXPECT_TRUE(first.commit()) << first.error();
  EXPECT_EQ(test::read_file(directory.path("x")), "first");
}

TEST(PartialFile, DoesNotRenameAReplacedFile) {
  const test::TemporaryDirectory directory;
  PartialFile file;
  ASSERT_TRUE(file.open(directory.path("x")));
  fs::remove(directory.path("x.partial"));
  test::write_file(directory.path("x.partial"), "of somebody else");
  EXPECT_FALSE(file.commit());
  EXPECT_NE(file.error().find("replaced"), std::string::npos) << file.error();
  EXPECT_EQ(directory.names(), Names{"x.partial"});
}

TEST(PartialFile, ReplacesOnlyFiles) {
  const test::TemporaryDirectory directory;
  fs::create_directory(directory.path("folder"));
  ASSERT_EQ(::mkfifo(directory.path("pipe").c_str(), 0600), 0);
  PartialFile file;
  EXPECT_FALSE(file.open(directory.path("folder")));
  EXPECT_EQ(file.error(), "is a directory");
  EXPECT_FALSE(file.open(directory.path("pipe")));
  EXPECT_EQ(file.error(), "exists and is not a regular file");
  EXPECT_FALSE(file.open(directory.path("no folder/x")));
  ASSERT_EQ(::mkfifo(directory.path("x.partial").c_str(), 0600), 0);
  EXPECT_FALSE(file.open(directory.path("x")));
  EXPECT_EQ(directory.names(), (Names{"folder", "pipe", "x.partial"}));
}

TEST(PartialFile, AreRemovedWhenASignalEndsTheProcess) {
  const test::TemporaryDirectory directory;
  PartialFile open, whole;
  ASSERT_TRUE(open.open(directory.path("open")));
  ASSERT_TRUE(whole.open(directory.path("whole")));
  ASSERT_TRUE(whole.commit());
  testing::internal::CaptureStderr();
  remove_partial_files();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(said, "framewatch: stopping; removed " + directory.path("open.partial") + "\n");
  EXPECT_EQ(directory.names(), Names{"whole"});
}

TEST(OwnFile, RefusesLinksAndPipes) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("victim"), kVictim);
  fs::create_symlink(directory.path("victim"), directory.path("link"));
  ASSERT_EQ(::mkfifo(directory.path("pipe").c_str(), 0600), 0);
  EXPECT_EQ(open_own_file(directory.path("link"), O_RDWR | O_CREAT), -1);
  EXPECT_EQ(errno, ELOOP);
  EXPECT_EQ(open_own_file(directory.path("pipe"), O_RDONLY), -1) << "and did not wait";
  const int made = open_own_file(directory.path("lock"), O_RDWR | O_CREAT);
  EXPECT_GE(made, 0);
  ::close(made);
}

}  // namespace partial_file_test
}  // namespace framewatch::drivers
