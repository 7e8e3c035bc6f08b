#include "drivers/base/trial_process.h"

#include <sys/resource.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace framewatch::drivers {
namespace {

void bound(int resource, int most) {
  const rlimit limit{static_cast<rlim_t>(most), static_cast<rlim_t>(most)};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

}  // namespace

bool survives_apart(const std::function<void()>& attempt, int most_cpu_s) {
  const pid_t child = ::fork();
  if (child == 0) {
    bound(RLIMIT_CORE, 0);
    bound(RLIMIT_CPU, most_cpu_s);
    attempt();
    ::_exit(0);
  }
  int status = -1;
  while (child > 0 && ::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace framewatch::drivers
