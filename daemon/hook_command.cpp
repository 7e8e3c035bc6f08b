#include "daemon/hook_command.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>

#include <fmt/core.h>

#include "daemon/clocks.h"
#include "daemon/descriptor.h"
#include "daemon/event_words.h"
#include "daemon/history_files.h"

namespace framewatch::daemon {
namespace {

constexpr int kLook_ms = 20;
constexpr std::int64_t kGrace_us = 1'000'000;  // between asking to end and ending
constexpr std::size_t kMostSaid = 200;         // of its output, for the trouble
constexpr int kMostReads = 64;                 ///< of one look

bool is_ours(std::string_view entry) {
  for (const char* name : {"NOTIFY_SOCKET=", "WATCHDOG_", "LISTEN_", "FRAMEWATCH_"})
    if (entry.starts_with(name)) return true;
  return false;
}

/// Without what belongs to this process alone.
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

/// The process, or -1 and errno in `failure`.
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

/// Some of what is there to be read, its end kept: who writes without end is not read without end.
void read_some(int file, std::string& said) {
  std::array<char, 4096> buffer;
  for (int i = 0; i < kMostReads; ++i) {
    const ssize_t n = ::read(file, buffer.data(), buffer.size());
    if (n <= 0) return;
    said.append(buffer.data(), static_cast<std::size_t>(n));
    if (said.size() > kMostSaid) said.erase(0, said.size() - kMostSaid);
  }
}

/// Its last line.
std::string last_line(std::string said) {
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.pop_back();
  const auto newline = said.rfind('\n');
  return newline == std::string::npos ? said : said.substr(newline + 1);
}

/// Waits until it has ended, and sees to it that it does.
int wait_for(pid_t pid, int output, std::string& said, double timeout_s, const Abandoned& abandoned,
             bool& ended_by_us) {
  const std::int64_t until_us = steady_clock_us() + static_cast<std::int64_t>(1e6 * timeout_s);
  std::int64_t kill_us = 0;
  for (int status = 0;;) {
    pollfd more{output, POLLIN, 0};
    ::poll(&more, 1, kLook_ms);
    read_some(output, said);
    const pid_t gone = ::waitpid(pid, &status, WNOHANG);
    if (gone == pid || (gone < 0 && errno == ECHILD)) {
      read_some(output, said);
      return status;
    }
    // Its output may be closed while it runs.
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
  return {{"FRAMEWATCH_BUILDING", building},
          {"FRAMEWATCH_EVENT_ID", fmt::format("{}", e.id)},
          {"FRAMEWATCH_STATE", word(kEventStates, e.state)},
          {"FRAMEWATCH_SEVERITY", word(kSeverities, e.severity)},
          {"FRAMEWATCH_KIND", e.kind},
          {"FRAMEWATCH_PLACE", e.place},
          {"FRAMEWATCH_MESSAGE", e.message},
          {"FRAMEWATCH_VALUE", number(e.value)},
          {"FRAMEWATCH_STD_ERROR", number(e.std_error)},
          {"FRAMEWATCH_UNIT", e.unit},
          {"FRAMEWATCH_SEGMENT", e.segment},
          {"FRAMEWATCH_TIME", utc_text(e.time_us)},
          {"FRAMEWATCH_SINCE", utc_text(e.since_us)}};
}

Told run_hook(const ActionSettings& settings, const std::string& input,
              const std::vector<std::pair<std::string, std::string>>& environment,
              const Abandoned& abandoned) {
  if (settings.command.empty()) return {"no command is configured any more", false};
  const std::string& name = settings.command.front();
  const auto trouble = [&](const std::string& why) { return Told{name + ": " + why, false}; };
  // A file in memory: who does not read its input, delays nobody.
  const Descriptor in(::memfd_create("event", MFD_CLOEXEC));
  int ends[2];
  if (in.get() < 0 || ::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
    return trouble(std::strerror(errno));
  const Descriptor out(ends[0]);
  Descriptor its_out(ends[1]);
  if (::write(in.get(), input.data(), input.size()) != static_cast<ssize_t>(input.size()) ||
      ::lseek(in.get(), 0, SEEK_SET) != 0 || ::fcntl(its_out.get(), F_SETFL, 0) != 0)
    return trouble(std::strerror(errno));
  int failure = 0;
  const pid_t pid =
      start(settings.command, environment_with(environment), in.get(), its_out.get(), failure);
  its_out.reset(-1);
  if (pid < 0) return trouble(std::strerror(failure));
  std::string said;
  bool ended_by_us = false;
  const int status =
      wait_for(pid, out.get(), said, settings.command_timeout_s, abandoned, ended_by_us);
  if (ended_by_us) {
    ::kill(-pid, SIGKILL);  // whoever of its group did not hear
    return trouble(abandoned() ? "ended, framewatch stops"
                               : fmt::format("ended after {:g} s", settings.command_timeout_s));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string line = last_line(said);
  return trouble((WIFEXITED(status) ? fmt::format("exit status {}", WEXITSTATUS(status))
                                    : fmt::format("signal {}", WTERMSIG(status))) +
                 (line.empty() ? "" : ": " + line));
}

}  // namespace framewatch::daemon
