// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/command_socket.h"

#include <fcntl.h>
#include <linux/capability.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/base/process.h"
#include "daemon/monitor/service/command_client.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace command_socket_test {

using namespace std::chrono_literals;

// Limits.
constexpr auto kSoon = 30s;                   // for short actions on an idle machine
constexpr std::int64_t kLook_us = 1'000'000;  // poll() never waits; this is for a busy machine

/// A daemon that answers every command with its bytes and names its user.
class Commands : public testing::Test {
 protected:
  Commands() {
    config_.commands.directory = directory_.path("commands");
    config_.lcm.prefix = "P_";
  }
  ~Commands() override { stop(); }

  std::unique_ptr<CommandSocket> listen() {
    return std::make_unique<CommandSocket>(
        config_, "run", [this](const CommandPacket& command, const std::string& user) {
          ++commands_;
          user_ = user;
          if (command.channel == "NO") return refused("not now\x1b");
          return CommandPacket{command.channel, command.bytes};
        });
  }
  /// Polls in a thread, as a daemon's loop does, until stop().
  void serve(CommandSocket& socket) {
    loop_ = std::thread([this, &socket] {
      while (!stopping_) {
        const std::int64_t began_us = steady_clock_us();
        socket.poll(began_us + ahead_us_);
        longest_us_ = std::max<std::int64_t>(longest_us_, steady_clock_us() - began_us);
        std::this_thread::sleep_for(5ms);
      }
    });
  }
  void stop() {
    stopping_ = true;
    if (loop_.joinable()) loop_.join();
    stopping_ = false;
  }
  std::string path() const { return directory_.path("commands/P_run"); }
  CommandAnswer ask(const std::string& channel, std::vector<std::uint8_t> bytes = {1, 0, 2}) const {
    return give_command(config_, "run", {channel, std::move(bytes)});
  }
  /// Opens a connection that sends nothing. Returns -1 if that fails.
  int connect() const {
    const int file = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof address.sun_path - 1);
    timeval wait{30, 0};
    for (const int option : {SO_SNDTIMEO, SO_RCVTIMEO})
      ::setsockopt(file, SOL_SOCKET, option, &wait, sizeof wait);
    if (::connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      return file;
    ::close(file);
    return -1;
  }
  /// Returns true if the daemon closes the connection without an answer.
  static bool hung_up(int file) {
    char byte = 0;
    return ::recv(file, &byte, 1, 0) == 0;
  }

  test::TemporaryDirectory directory_;
  Config config_;
  std::thread loop_;
  std::atomic<bool> stopping_ = false;
  std::atomic<std::int64_t> ahead_us_ = 0, longest_us_ = 0;
  std::atomic<int> commands_ = 0;
  std::string user_;
};

TEST_F(Commands, AreAnsweredAndCarryTheUserOfTheKernel) {
  const auto socket = listen();
  ASSERT_EQ(socket->problem(), "");
  struct stat found {};
  ASSERT_EQ(::stat(path().c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0660u);
  serve(*socket);
  const CommandAnswer answer = ask("YES");
  EXPECT_TRUE(answer.answered);
  EXPECT_EQ(answer.problem, "");
  EXPECT_EQ(answer.bytes, (std::vector<std::uint8_t>{1, 0, 2}));
  const CommandAnswer no = ask("NO");
  EXPECT_TRUE(no.answered);
  EXPECT_EQ(no.problem, "not now\x1b");  // the reader escapes it
  stop();
  EXPECT_EQ(user_, user_name(::geteuid()));
}

TEST_F(Commands, NameAnotherUser) {
  constexpr uid_t kNobody = 65534;
  const auto socket = listen();
  std::filesystem::permissions(directory_.path(""), std::filesystem::perms(0755));
  std::filesystem::permissions(config_.commands.directory, std::filesystem::perms(0755));
  std::filesystem::permissions(path(), std::filesystem::perms(0666));
  const pid_t child = ::fork();
  if (child == 0) ::_exit(::setuid(kNobody) != 0 ? 77 : ask("YES").answered ? 0 : 1);
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) socket->poll(steady_clock_us());
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "there is no other user in this namespace";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(user_, user_name(kNobody));
}

TEST_F(Commands, ReportAMissingDaemon) {
  const CommandAnswer answer = ask("YES");
  EXPECT_FALSE(answer.answered);
  EXPECT_NE(answer.problem.find("no framewatch run takes commands here"), std::string::npos);
  EXPECT_NE(answer.problem.find(path()), std::string::npos);
}

TEST_F(Commands, TellAUserWithoutRightsWhichGroupHasThem) {
  const auto socket = listen();
  ::chmod(path().c_str(), 0);
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    // Drops root's right to everything.
    __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
    __user_cap_data_struct none[2]{};
    const bool dropped = ::syscall(SYS_capset, &header, none) == 0;
    const std::string problem = dropped ? ask("YES").problem : "cannot drop capabilities";
    (void)!::write(ends[1], problem.data(), problem.size());
    ::_exit(0);
  }
  ::close(ends[1]);
  char text[2000];
  const ssize_t got = ::read(ends[0], text, sizeof text);
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  const std::string problem(text, static_cast<std::size_t>(std::max<ssize_t>(0, got)));
  const std::string group = group_name(::getegid());
  EXPECT_NE(problem.find("no permission"), std::string::npos) << problem;
  EXPECT_NE(problem.find("members of the group " + group), std::string::npos) << problem;
  EXPECT_NE(problem.find("usermod -aG " + group), std::string::npos) << problem;
}

TEST_F(Commands, ReplaceASocketOnlyIfItsProcessIsDead) {
  ASSERT_EQ(prepare_command_directory(config_.commands.directory), "");
  {  // as a killed process leaves it
    const int file = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(file);
    test::write_file(path() + ".lock", "");
  }
  EXPECT_NE(ask("YES").problem.find("takes commands here"), std::string::npos);
  auto first = listen();
  EXPECT_EQ(first->problem(), "");
  testing::internal::CaptureStderr();
  auto second = listen();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("cannot take commands: " + path()), std::string::npos) << said;
  EXPECT_NE(said.find("another framewatch run"), std::string::npos) << said;
  serve(*first);
  EXPECT_TRUE(ask("YES").answered);
  stop();
  second->poll(steady_clock_us() + 60 * kSecond_us);
  EXPECT_NE(second->problem(), "");
  first.reset();
  ahead_us_ = 120 * kSecond_us;  // it tries again
  serve(*second);
  EXPECT_TRUE(test::comes_true([&] { return ask("YES").answered; }, kSoon));
  stop();
  EXPECT_EQ(second->problem(), "");
}

TEST_F(Commands, UseASocketPerPrefix) {
  const auto first = listen();
  config_.lcm.prefix = "../Q/";
  const auto second = listen();
  EXPECT_EQ(second->problem(), "");
  EXPECT_EQ(second->path(), directory_.path("commands/%2e%2e%2fQ%2frun"));
  EXPECT_NE(first->path(), second->path());
}

TEST_F(Commands, RefuseADirectoryThatOthersMayWrite) {
  const std::string directory = config_.commands.directory;
  std::filesystem::create_directory(directory);
  ::chmod(directory.c_str(), 0777);
  EXPECT_NE(listen()->problem().find("others may write"), std::string::npos);
  ::chmod(directory.c_str(), 01777);
  EXPECT_NE(listen()->problem().find("others may write"), std::string::npos);
  ::chmod(directory.c_str(), 0770);
  EXPECT_NE(listen()->problem().find("others may write"), std::string::npos);
  ::chmod(directory.c_str(), 01770);
  EXPECT_EQ(listen()->problem(), "");
  std::filesystem::create_directory_symlink(directory, directory_.path("link"));
  config_.commands.directory = directory_.path("link");
  EXPECT_NE(listen()->problem().find("is not a directory"), std::string::npos);
  config_.commands.directory = directory_.path("none/none");
  EXPECT_NE(listen()->problem(), "");
  config_.commands.directory = directory_.path(std::string(120, 'x'));
  EXPECT_NE(listen()->problem().find("107 bytes"), std::string::npos);
}

TEST_F(Commands, UseTheDirectoryOfUnitSessionOrTmp) {
  config_.commands.directory.clear();
  ::setenv("RUNTIME_DIRECTORY", "/run/a:/run/b", 1);
  EXPECT_EQ(command_directory(config_), "/run/a");
  ::unsetenv("RUNTIME_DIRECTORY");
  ::setenv("XDG_RUNTIME_DIR", directory_.path("").c_str(), 1);
  EXPECT_EQ(command_directory(config_), directory_.path("") + "/framewatch");
  ::setenv("XDG_RUNTIME_DIR", "/nonexistent", 1);
  EXPECT_EQ(command_directory(config_), "/tmp/framewatch-" + std::to_string(::geteuid()));
  ::unsetenv("XDG_RUNTIME_DIR");
  EXPECT_EQ(command_directories(config_).back(), "/run/framewatch");
}

TEST_F(Commands, CloseASilentConnectionWithoutDelayingOthers) {
  const auto socket = listen();
  serve(*socket);
  const int silent = connect();
  ASSERT_GE(silent, 0);
  EXPECT_TRUE(ask("YES").answered);
  ahead_us_ = CommandSocket::kPatience_us + kSecond_us;
  EXPECT_TRUE(hung_up(silent));
  ::close(silent);
  // A client that does not wait for its answer.
  const int rude = connect();
  ASSERT_EQ(::send(rude, "YES\0", 4, 0), 4);
  ::close(rude);
  EXPECT_TRUE(ask("YES").answered);
  EXPECT_TRUE(test::comes_true([&] { return commands_ == 3; }, kSoon));
  stop();
  EXPECT_LT(longest_us_, kLook_us);
}

TEST_F(Commands, ServeOthersBesideAHundredSilentConnections) {
  const auto socket = listen();
  serve(*socket);
  std::vector<int> silent;
  for (int i = 0; i < 100; ++i) silent.push_back(connect());
  const std::int64_t began_us = steady_clock_us();
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(ask("YES").answered);
  EXPECT_LT(steady_clock_us() - began_us, 30 * kSecond_us);
  stop();
  EXPECT_LT(longest_us_, kLook_us);
  int held = 0;
  for (const int file : silent) {
    char byte = 0;
    held += ::recv(file, &byte, 1, MSG_DONTWAIT) < 0 ? 1 : 0;
    ::close(file);
  }
  EXPECT_LE(held, static_cast<int>(CommandSocket::kMaxConnections));
}

TEST_F(Commands, CountAndIgnoreMalformedCommands) {
  const auto socket = listen();
  serve(*socket);
  const std::vector<std::string> junk = {
      "no zero byte", std::string("\0no channel", 11), std::string(64, 'x') + '\0',
      "YES" + std::string(CommandPacket::kMaxBytes, '\0'), std::string(150'000, '\xff')};
  for (const std::string& bytes : junk) {
    const int file = connect();
    ASSERT_GE(file, 0);
    ASSERT_EQ(::send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
    EXPECT_TRUE(hung_up(file));
    ::close(file);
  }
  EXPECT_EQ(commands_, 0);
  std::vector<std::uint8_t> most(CommandPacket::kMaxBytes - 4, 7);
  EXPECT_EQ(ask("YES", most).bytes, most);
  most.push_back(7);
  EXPECT_NE(ask("YES", most).problem.find("65536 bytes at most"), std::string::npos);
  stop();
  EXPECT_EQ(socket->malformed(), std::ssize(junk));
}

}  // namespace command_socket_test
}  // namespace framewatch::daemon
