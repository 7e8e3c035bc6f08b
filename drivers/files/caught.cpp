// SPDX-License-Identifier: MIT
#include "drivers/files/caught.h"

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <new>

namespace framewatch::drivers {
namespace {

void limit_to(int resource, int most) {
  const rlimit limit{static_cast<rlim_t>(most), static_cast<rlim_t>(most) + 1};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

}  // namespace

std::string caught(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const std::bad_alloc&) {
    return "there is not enough memory";
  } catch (const std::exception& error) {
    return *error.what() != 0 ? error.what() : "an exception without a text";
  } catch (...) {
    return "an exception of an unknown kind";
  }
}

AttemptEnd try_apart(const std::function<void()>& attempt, int most_cpu_s) {
  const pid_t child = ::fork();
  if (child == 0) {
    limit_to(RLIMIT_CORE, 0);
    limit_to(RLIMIT_CPU, most_cpu_s);
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(static_cast<unsigned>(10 * most_cpu_s));
    try {
      attempt();
    } catch (...) {  // the parent meets the same exception and handles it
    }
    ::_exit(0);
  }
  if (child < 0) return AttemptEnd::not_begun;
  int status = -1;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return AttemptEnd::survived;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return signal == SIGALRM || signal == SIGXCPU ? AttemptEnd::too_long : AttemptEnd::crashed;
}

}  // namespace framewatch::drivers
