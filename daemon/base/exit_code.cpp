// SPDX-License-Identifier: MIT
#include "daemon/base/exit_code.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "drivers/files/caught.h"
#include "drivers/files/partial_file.h"

namespace framewatch::daemon {
namespace {

/// Global because std::terminate() passes no arguments.
std::string running_command;
int status_when_thrown = kBadInput;

/// fmt::print throws when stderr cannot be written.
void say(const std::string& text) {
  const std::string line =
      "framewatch" + (running_command.empty() ? "" : " " + running_command) + ": " + text + "\n";
  (void)std::fputs(line.c_str(), stderr);
}

void say_thrown(const std::string& what) {
  say(what + " (an error that nothing expected)");
}

extern "C" void clean_up_and_end(int number) {
  drivers::remove_partial_files();
  ::raise(number);  // as it would have ended; SA_RESETHAND
}

[[noreturn]] void end_terminated() {
  const std::exception_ptr thrown = std::current_exception();
  say_thrown(thrown ? drivers::caught([&] { std::rethrow_exception(thrown); })
                    : "ended by std::terminate");
  drivers::remove_partial_files();
  ::_exit(status_when_thrown);
}

}  // namespace

void prepare_last_resort() {
  // Otherwise the first opened file would become standard output.
  for (int stream = 0; stream <= 2; ++stream)
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      (void)::open("/dev/null", stream == 2 ? O_WRONLY : O_RDONLY);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT, SIGXCPU, SIGXFSZ, SIGALRM}) {
    struct sigaction action {};
    if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler != SIG_DFL) continue;
    action.sa_handler = clean_up_and_end;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(number, &action, nullptr);
  }
  std::set_terminate(&end_terminated);
}

void now_runs(const std::string& command, bool service) {
  running_command = command;
  status_when_thrown = service ? kFailed : kBadInput;
}

int run_to_the_end(const std::function<int()>& run) {
  int status = 0;
  const std::string thrown = drivers::caught([&] { status = run(); });
  if (!thrown.empty()) {
    say_thrown(thrown);
    status = status_when_thrown;
  }
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  say(std::string("standard output: ") +
      (errno != 0 ? std::strerror(errno) : "it did not take everything"));
  return thrown.empty() ? kBadInput : status;
}

int refuse(const std::string& command, const std::string& message) {
  fmt::print(stderr, "{} {}\n", toned(Tone::bad, "framewatch " + command + ":", stderr),
             printable_lines(message));
  return kBadInput;
}

}  // namespace framewatch::daemon
