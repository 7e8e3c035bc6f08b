// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/receivers.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/descriptor.h"

namespace framewatch::daemon {
namespace {

constexpr int kLook_ms = 20;
constexpr std::int64_t kGrace_us = 1'000'000;  // between SIGTERM and SIGKILL
constexpr std::size_t kMaxOutput = 200;        // bytes of output that are kept
constexpr int kMaxReads = 64;                  // in one call

bool is_ours(std::string_view entry) {
  for (const char* name : {"NOTIFY_SOCKET=", "WATCHDOG_", "LISTEN_", "FRAMEWATCH_"})
    if (entry.starts_with(name)) return true;
  return false;
}

/// Returns the environment of this process with `more` variables, without systemd's and
/// framewatch's own.
std::vector<std::string> environment_with(
    const std::vector<std::pair<std::string, std::string>>& more) {
  std::vector<std::string> out;
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (!is_ours(*entry)) out.emplace_back(*entry);
  for (const auto& [name, value] : more) out.push_back(name + "=" + value);
  return out;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> out;
  for (std::string& text : texts) out.push_back(text.data());
  out.push_back(nullptr);
  return out;
}

/// Starts the process. Returns -1 and sets `failure` to an errno on failure.
pid_t start(std::vector<std::string> arguments, std::vector<std::string> environment, int input,
            int output, int& failure) {
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  ::posix_spawn_file_actions_addclosefrom_np(&files, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t none, every;
  sigemptyset(&none);
  sigfillset(&every);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &every);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  pid_t pid = -1;
  failure = ::posix_spawnp(&pid, arguments.front().c_str(), &files, &attributes,
                           pointers(arguments).data(), pointers(environment).data());
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return failure == 0 ? pid : -1;
}

/// Reads the available output, up to kMaxReads blocks, and keeps its last kMaxOutput bytes.
void read_some(int file, std::string& output) {
  std::array<char, 4096> buffer;
  for (int i = 0; i < kMaxReads; ++i) {
    const ssize_t n = ::read(file, buffer.data(), buffer.size());
    if (n <= 0) return;
    output.append(buffer.data(), static_cast<std::size_t>(n));
    if (output.size() > kMaxOutput) output.erase(0, output.size() - kMaxOutput);
  }
}

std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const auto newline = text.rfind('\n');
  return newline == std::string::npos ? text : text.substr(newline + 1);
}

/// Waits until the process has ended and returns its wait status. Ends it after timeout_s or when
/// abandoned, and sets `ended_by_us`.
int wait_for(pid_t pid, int pipe_end, std::string& output, double timeout_s,
             const Abandoned& abandoned, bool& ended_by_us) {
  const std::int64_t until_us = steady_clock_us() + static_cast<std::int64_t>(1e6 * timeout_s);
  std::int64_t kill_us = 0;
  for (int status = 0;;) {
    pollfd more{pipe_end, POLLIN, 0};
    ::poll(&more, 1, kLook_ms);
    read_some(pipe_end, output);
    const pid_t gone = ::waitpid(pid, &status, WNOHANG);
    if (gone == pid || (gone < 0 && errno == ECHILD)) {
      read_some(pipe_end, output);
      return status;
    }
    // It may close its output and continue to run.
    if ((more.revents & POLLHUP) != 0) ::usleep(1000 * kLook_ms);
    const std::int64_t now_us = steady_clock_us();
    if (!ended_by_us && (now_us >= until_us || abandoned())) {
      ended_by_us = true;
      kill_us = now_us + kGrace_us;
      ::kill(-pid, SIGTERM);
    }
    if (ended_by_us && now_us >= kill_us) ::kill(-pid, SIGKILL);
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> event_environment(const event_t& e,
                                                                   const std::string& building) {
  const auto number = [](double v) { return std::isfinite(v) ? fmt::format("{}", v) : ""; };
  return {{"FRAMEWATCH_BUILDING", printable(building)},
          {"FRAMEWATCH_EVENT_ID", fmt::format("{}", e.id)},
          {"FRAMEWATCH_STATE", word(kEventStates, e.state)},
          {"FRAMEWATCH_SEVERITY", word(kSeverities, e.severity)},
          {"FRAMEWATCH_KIND", printable(e.kind)},
          {"FRAMEWATCH_PLACE", printable(e.place)},
          {"FRAMEWATCH_MESSAGE", printable(e.message)},
          {"FRAMEWATCH_VALUE", number(e.value)},
          {"FRAMEWATCH_STD_ERROR", number(e.std_error)},
          {"FRAMEWATCH_UNIT", printable(e.unit)},
          {"FRAMEWATCH_SEGMENT", printable(e.segment)},
          {"FRAMEWATCH_TIME", utc_text(e.time_us)},
          {"FRAMEWATCH_SINCE", utc_text(e.since_us)}};
}

DeliveryResult run_hook(const ActionSettings& settings, const std::string& input,
                        const std::vector<std::pair<std::string, std::string>>& environment,
                        const Abandoned& abandoned) {
  if (settings.command.empty()) return {"the command was removed from [actions]", false};
  const std::string& name = settings.command.front();
  const auto trouble = [&](const std::string& why) {
    return DeliveryResult{name + ": " + why, false};
  };
  // A file in memory instead of a pipe: a command that does not read its input delays nothing.
  const drivers::Descriptor in(::memfd_create("event", MFD_CLOEXEC));
  int ends[2];
  if (in.get() < 0 || ::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
    return trouble(std::strerror(errno));
  const drivers::Descriptor out(ends[0]);
  drivers::Descriptor its_out(ends[1]);
  if (::write(in.get(), input.data(), input.size()) != static_cast<ssize_t>(input.size()) ||
      ::lseek(in.get(), 0, SEEK_SET) != 0 || ::fcntl(its_out.get(), F_SETFL, 0) != 0)
    return trouble(std::strerror(errno));
  int failure = 0;
  const pid_t pid =
      start(settings.command, environment_with(environment), in.get(), its_out.get(), failure);
  its_out.reset(-1);
  if (pid < 0) return trouble(std::strerror(failure));
  std::string output;
  bool ended_by_us = false;
  const int status =
      wait_for(pid, out.get(), output, settings.command_timeout_s, abandoned, ended_by_us);
  if (ended_by_us) {
    ::kill(-pid, SIGKILL);  // processes of its group that ignored SIGTERM
    return trouble(abandoned() ? "ended because framewatch stops"
                               : fmt::format("ended after {:g} s", settings.command_timeout_s));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string line = last_line(output);
  return trouble((WIFEXITED(status) ? fmt::format("exit status {}", WEXITSTATUS(status))
                                    : fmt::format("signal {}", WTERMSIG(status))) +
                 (line.empty() ? "" : ": " + line));
}

}  // namespace framewatch::daemon
