// SPDX-License-Identifier: MIT
#include "daemon/base/process.h"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/core.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxEntry = 65536, kMaxName = 64;  // bytes

}  // namespace

std::string user_name(uid_t user) {
  std::vector<char> memory(kMaxEntry);
  passwd entry{};
  passwd* found = nullptr;
  if (::getpwuid_r(user, &entry, memory.data(), memory.size(), &found) == 0 && found != nullptr)
    return printable(found->pw_name, kMaxName);
  // A dynamic user of systemd exists only while the service runs; systemd passes its name.
  const char* const own = user == ::geteuid() ? std::getenv("USER") : nullptr;
  return own != nullptr ? printable(own, kMaxName) : fmt::format("uid {}", user);
}

std::string group_name(gid_t group) {
  std::vector<char> memory(kMaxEntry);
  struct group entry {};
  struct group* found = nullptr;
  if (::getgrgid_r(group, &entry, memory.data(), memory.size(), &found) != 0 || found == nullptr)
    return fmt::format("gid {}", group);
  return printable(found->gr_name, kMaxName);
}

std::int64_t random_id() {
  std::random_device source;
  return 1 + (std::int64_t{source()} << 20 | std::int64_t{source() >> 12});
}

std::optional<ChildProcess> ChildProcess::start(std::vector<std::string> arguments,
                                                std::string& error, const std::string& program,
                                                const std::string& errors) {
  std::string name = "framewatch";
  std::vector<char*> pointers{name.data()};
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  if (!errors.empty())
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600);
  pid_t pid = 0;
  const int failure =
      ::posix_spawn(&pid, program.c_str(), &actions, nullptr, pointers.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (failure == 0) return ChildProcess(pid);
  error = std::strerror(failure);
  return std::nullopt;
}

std::optional<int> ChildProcess::ended() {
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

ProcessUsage process_usage() {
  ProcessUsage usage;
  std::int64_t pages = 0, resident = 0;
  if (std::ifstream("/proc/self/statm") >> pages >> resident)
    usage.resident_bytes = resident * ::sysconf(_SC_PAGESIZE);
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  usage.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  return usage;
}

std::int64_t disk_free_bytes(const std::string& path) {
  std::error_code problem;
  std::filesystem::path at = std::filesystem::absolute(path, problem);
  while (!std::filesystem::exists(at, problem) && at != at.parent_path()) at = at.parent_path();
  const auto space = std::filesystem::space(at, problem);
  return problem ? -1 : static_cast<std::int64_t>(space.available);
}

}  // namespace framewatch::daemon
