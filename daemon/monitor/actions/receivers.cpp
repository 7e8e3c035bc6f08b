// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/receivers.h"

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
#include <cstddef>
#include <cstring>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>

#include <curl/curl.h>
#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
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

struct Free {
  void operator()(CURL* curl) const { ::curl_easy_cleanup(curl); }
  void operator()(curl_slist* list) const { ::curl_slist_free_all(list); }
};
using Headers = std::unique_ptr<curl_slist, Free>;

void add(Headers& headers, const std::string& line) {
  curl_slist* const longer = ::curl_slist_append(headers.get(), line.c_str());
  if (longer == nullptr) return;
  (void)headers.release();
  headers.reset(longer);
}

std::size_t ignore_body(const char*, std::size_t size, std::size_t count, void*) {
  return size * count;
}

int should_stop(void* abandoned, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return (*static_cast<const Abandoned*>(abandoned))() ? 1 : 0;
}

/// Adds one header per line; skips empty lines and comments (#).
void add_lines(Headers& headers, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
    if (!line.empty() && line.front() != '#') add(headers, line);
  }
}

/// Returns true if another attempt may succeed after this HTTP status.
bool may_pass(long status) {
  constexpr std::array<long, 3> kLater = {408, 425, 429};
  return status >= 500 || std::find(kLater.begin(), kLater.end(), status) != kLater.end();
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

DeliveryResult post_webhook(const ActionSettings& settings, const std::string& json,
                            const Abandoned& abandoned) {
  if (settings.webhook.empty()) return {"the webhook was removed from [actions]", false};
  Headers headers;
  add(headers, "Content-Type: application/json");
  add(headers, "Expect:");
  if (!settings.webhook_header_file.empty()) {
    std::string trouble;
    const std::optional<std::string> text = read_text_file(settings.webhook_header_file, trouble);
    if (!text) return {settings.webhook_header_file + ": " + trouble, true};
    add_lines(headers, *text);
  }
  static const CURLcode ready = ::curl_global_init(CURL_GLOBAL_DEFAULT);
  std::array<char, CURL_ERROR_SIZE> error{};
  const std::unique_ptr<CURL, Free> curl(ready == CURLE_OK ? ::curl_easy_init() : nullptr);
  if (!curl) return {"libcurl cannot start", true};
  const auto set = [&](CURLoption option, auto value) {
    ::curl_easy_setopt(curl.get(), option, value);
  };
  const auto timeout_ms = static_cast<long>(1e3 * settings.webhook_timeout_s);
  set(CURLOPT_URL, settings.webhook.c_str());
  set(CURLOPT_PROTOCOLS_STR, "http,https");
  set(CURLOPT_FOLLOWLOCATION, 0L);
  set(CURLOPT_SSL_VERIFYPEER, 1L);
  set(CURLOPT_SSL_VERIFYHOST, 2L);
  if (!settings.webhook_ca_file.empty()) {
    set(CURLOPT_CAINFO, settings.webhook_ca_file.c_str());
    set(CURLOPT_CAPATH, static_cast<const char*>(nullptr));
  }
  set(CURLOPT_NOSIGNAL, 1L);
  set(CURLOPT_QUICK_EXIT, 1L);  // a slow name server must not delay the end of the program
  set(CURLOPT_TIMEOUT_MS, timeout_ms);
  set(CURLOPT_CONNECTTIMEOUT_MS, timeout_ms);
  set(CURLOPT_USERAGENT, "framewatch/" FRAMEWATCH_VERSION);
  set(CURLOPT_HTTPHEADER, headers.get());
  set(CURLOPT_POSTFIELDSIZE, static_cast<long>(json.size()));
  set(CURLOPT_POSTFIELDS, json.c_str());
  set(CURLOPT_WRITEFUNCTION, &ignore_body);
  set(CURLOPT_NOPROGRESS, 0L);
  set(CURLOPT_XFERINFOFUNCTION, &should_stop);
  set(CURLOPT_XFERINFODATA, &abandoned);
  set(CURLOPT_ERRORBUFFER, error.data());
  const CURLcode result = ::curl_easy_perform(curl.get());
  if (result != CURLE_OK)
    return {error[0] != '\0' ? error.data() : ::curl_easy_strerror(result), true};
  long status = 0;
  ::curl_easy_getinfo(curl.get(), CURLINFO_RESPONSE_CODE, &status);
  if (status >= 200 && status < 300) return {};
  return {fmt::format("the server answers {}", status), may_pass(status)};
}

}  // namespace framewatch::daemon
