#include "drivers/files/trial_process.h"

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace framewatch::drivers {
namespace {

void bound(int resource, int most) {
  const rlimit limit{static_cast<rlim_t>(most), static_cast<rlim_t>(most) + 1};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

}  // namespace

Trial try_apart(const std::function<void()>& attempt, int most_cpu_s) {
  const pid_t child = ::fork();
  if (child == 0) {
    bound(RLIMIT_CORE, 0);
    bound(RLIMIT_CPU, most_cpu_s);
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(static_cast<unsigned>(10 * most_cpu_s));
    try {
      attempt();
    } catch (...) {  // it is thrown again where it can be caught
    }
    ::_exit(0);
  }
  if (child < 0) return Trial::not_begun;
  int status = -1;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return Trial::survived;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  return signal == SIGALRM || signal == SIGXCPU ? Trial::too_long : Trial::crashed;
}

}  // namespace framewatch::drivers
