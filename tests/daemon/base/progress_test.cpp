// SPDX-License-Identifier: MIT
#include "daemon/base/progress.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "drivers/files/input_file.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace progress_test {

using namespace std::chrono_literals;

constexpr int kBytes = 200'000;
constexpr auto kDrawn = 3500ms;  // after the first 2 s it is drawn every half second

/// Makes standard error a terminal until it is destroyed.
class Terminal {
 public:
  Terminal() : terminal_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    EXPECT_EQ(::grantpt(terminal_), 0);
    EXPECT_EQ(::unlockpt(terminal_), 0);
    const int other = ::open(::ptsname(terminal_), O_RDWR | O_NOCTTY);
    EXPECT_EQ(::dup2(other, STDERR_FILENO), STDERR_FILENO);
    ::close(other);
  }
  ~Terminal() {
    ::dup2(before_, STDERR_FILENO);
    ::close(before_);
    ::close(terminal_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  std::string text() const {
    std::array<char, 4096> bytes{};
    const ssize_t got = ::read(terminal_, bytes.data(), bytes.size());
    return {bytes.data(), got > 0 ? static_cast<std::size_t>(got) : 0};
  }

 private:
  int before_ = ::dup(STDERR_FILENO);
  int terminal_;
};

TEST(ProgressLine, FollowsTheBytesReadFromFiles) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("x");
  test::write_file(path, std::string(kBytes, 'x'));
  const Terminal terminal;
  ProgressLine line("convert", false);
  ASSERT_TRUE(line.is_on());
  line.follow_reading("reading x", {path, path}, 1);
  drivers::InputFile file;
  ASSERT_TRUE(file.open(path));
  std::string half(kBytes / 2, '\0');
  ASSERT_EQ(file.read(half.data(), kBytes / 2, 0), kBytes / 2);
  std::this_thread::sleep_for(kDrawn);
  const std::string text = terminal.text();
  EXPECT_NE(text.find("convert: 25 %, "), std::string::npos) << text;
  EXPECT_NE(text.find(" s left, reading x"), std::string::npos) << text;
}

TEST(ProgressLine, PredictsNoTimeForACompressedLog) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("x.zst");
  test::write_file(path, std::string(kBytes, 'x'));
  const Terminal terminal;
  ProgressLine line("convert", false);
  line.follow_reading("reading x.zst", {path}, 1);
  std::this_thread::sleep_for(kDrawn);
  const std::string text = terminal.text();
  EXPECT_NE(text.find("convert: reading x.zst, "), std::string::npos) << text;
  EXPECT_EQ(text.find("left"), std::string::npos) << text;
}

}  // namespace progress_test
}  // namespace framewatch::daemon
