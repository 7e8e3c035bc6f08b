// SPDX-License-Identifier: MIT
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "drivers/files/packed_file.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace max_size_test {

constexpr std::int64_t kBombBytes = 100 << 20;  // of zeros: 10 kB packed

class MaxSize : public testing::Test {
 protected:
  void SetUp() override {
    const std::string zeros = directory_.path("zeros");
    test::write_file(zeros, "");
    std::filesystem::resize_file(zeros, kBombBytes);
    ASSERT_EQ(drivers::pack_zstd(zeros, directory_.path("x.lcmlog.zst"), std::atomic<bool>(false)),
              "");
    std::filesystem::copy(FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml",
                          directory_.path("table.toml"));
  }

  /// Returns the error message of a command about the bomb, which it must refuse.
  std::string said(const std::string& command) {
    const int status = std::system(
        fmt::format("cd {} && {} {} >said 2>&1", directory_.path(""), FRAMEWATCH_PROGRAM, command)
            .c_str());
    EXPECT_EQ(WEXITSTATUS(status), kBadInput) << command;
    return test::read_file(directory_.path("said"));
  }

  test::TemporaryDirectory directory_;
};

TEST_F(MaxSize, EveryCommandRefusesTooLargeFilesAndNamesTheOption) {
  for (const char* command :
       {"repair x.lcmlog.zst", "repair x.lcmlog.zst --check",
        "replay table.toml x.lcmlog.zst --out o.csv", "diff x.lcmlog.zst x.lcmlog.zst",
        "refine table.toml x.lcmlog.zst",
        "diagnose table.toml --train x.lcmlog.zst --holdout x.lcmlog.zst --out d",
        "convert x.lcmlog.zst o.csv", "report x.lcmlog.zst"}) {
    const std::string text = said(command);
    EXPECT_NE(text.find("x.lcmlog.zst: unpacks to more than 64 MiB, from "), std::string::npos)
        << command << "\n"
        << text;
    EXPECT_NE(text.find("--max-size"), std::string::npos) << command << "\n" << text;
  }
}

TEST_F(MaxSize, HoldsForTheLogsOfAHistory) {
  std::filesystem::create_directories(directory_.path("h/raw"));
  std::filesystem::copy(directory_.path("x.lcmlog.zst"),
                        directory_.path("h/raw/20261121T230000Z.lcmlog.zst"));
  EXPECT_NE(said("history h --raw o.csv").find("unpacks to more than 64 MiB"), std::string::npos);
}

TEST_F(MaxSize, AllowsMoreOrLess) {
  EXPECT_NE(said("repair x.lcmlog.zst --max-size 200MiB").find("holds no intact LCM event"),
            std::string::npos);
  EXPECT_NE(said("repair x.lcmlog.zst --max-size 1000").find("more than 1000 bytes"),
            std::string::npos);
  EXPECT_NE(said("repair x.lcmlog.zst --max-size no").find("--max-size"), std::string::npos);
  EXPECT_NE(said("repair x.lcmlog.zst --max-size 0").find("--max-size"), std::string::npos);
}

}  // namespace max_size_test
}  // namespace framewatch::daemon
