// SPDX-License-Identifier: MIT
#include "drivers/files/input_file.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "drivers/files/durable_file.h"
#include "drivers/files/line_reader.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace input_file_test {

using test::TemporaryDirectory;
using test::write_file;

/// Returns a path for each kind of thing that is not a file, with the message expected.
std::vector<std::pair<std::string, std::string>> no_files(const TemporaryDirectory& directory) {
  EXPECT_EQ(::mkfifo(directory.path("fifo").c_str(), 0600), 0);
  std::filesystem::create_directory(directory.path("folder"));
  std::filesystem::create_symlink(directory.path("loop"), directory.path("loop"));
  std::filesystem::create_symlink("/dev/zero", directory.path("zeros"));
  std::filesystem::create_symlink(directory.path("fifo"), directory.path("to_fifo"));
  const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::snprintf(address.sun_path, sizeof address.sun_path, "%s", directory.path("socket").c_str());
  EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ::close(socket);
  return {{directory.path("fifo"), "is a FIFO, not a file"},
          {directory.path("to_fifo"), "is a FIFO, not a file"},
          {directory.path("folder"), "is a directory, not a file"},
          {directory.path("socket"), "is a socket, not a file"},
          {directory.path("zeros"), "is a device, not a file"},
          {"/dev/null", "is a device, not a file"},
          {directory.path("loop"), "Too many levels of symbolic links"},
          {directory.path("none"), "No such file or directory"}};
}

TEST(InputFile, RefusesOtherThanFilesAtOnceWithTheReason) {
  const TemporaryDirectory directory;
  for (const auto& [path, word] : no_files(directory)) {
    InputFile file;
    EXPECT_FALSE(file.open(path)) << path;
    EXPECT_FALSE(file.is_open()) << path;
    EXPECT_EQ(file.error(), word) << path;
    EXPECT_EQ(why_no_file(path), word);
    std::string error;
    EXPECT_FALSE(read_whole_file(path, 1000, error)) << path;
    EXPECT_EQ(error, word);
    std::vector<Problem> found;
    FileProblems problems(path, found);
    LineReader lines(problems);
    std::string_view line;
    EXPECT_FALSE(lines.next(line));
    ASSERT_EQ(found.size(), 1u) << path;
    EXPECT_EQ(found[0].message, "cannot be opened: " + word);
  }
}

TEST(InputFile, IsAbsentOnlyIfTheNameDoesNotExist) {
  const TemporaryDirectory directory;
  for (const auto& [path, word] : no_files(directory))
    EXPECT_EQ(is_absent(path), path.ends_with("none")) << path;
  write_file(directory.path("file"), "");
  EXPECT_FALSE(is_absent(directory.path("file")));
  EXPECT_TRUE(is_absent(directory.path("file") + "/below"));
}

TEST(InputFile, DoesNotOpenAFifoToSeeIfItIsInUse) {
  const TemporaryDirectory directory;
  ASSERT_EQ(::mkfifo(directory.path("log.partial").c_str(), 0600), 0);
  EXPECT_FALSE(DurableFile::in_use(directory.path("log")));  // opening it would wait for a writer
}

TEST(InputFile, ReadsAFileThroughALink) {
  const TemporaryDirectory directory;
  write_file(directory.path("file"), "0123456789");
  std::filesystem::create_symlink(directory.path("file"), directory.path("link"));
  InputFile file;
  ASSERT_TRUE(file.open(directory.path("link"))) << file.error();
  EXPECT_EQ(file.size(), 10);
  std::string bytes(4, ' ');
  EXPECT_EQ(file.read(bytes.data(), 4, 3), 4);
  EXPECT_EQ(bytes, "3456");
  EXPECT_EQ(file.read(bytes.data(), 4, 8), 2);
  EXPECT_EQ(file.read(bytes.data(), 4, 20), 0);
}

TEST(InputFile, ReadsTheWholeFileOrNothing) {
  const TemporaryDirectory directory;
  const std::string text(3'000'000, 'x');
  write_file(directory.path("file"), text);
  std::string error;
  EXPECT_EQ(read_whole_file(directory.path("file"), 3'000'000, error), text);
  EXPECT_EQ(error, "");
  EXPECT_FALSE(read_whole_file(directory.path("file"), 2 << 20, error));
  EXPECT_EQ(error, "is larger than 2 MiB");
  write_file(directory.path("empty"), "");
  EXPECT_EQ(read_whole_file(directory.path("empty"), 10, error), "");
}

}  // namespace input_file_test
}  // namespace framewatch::drivers
