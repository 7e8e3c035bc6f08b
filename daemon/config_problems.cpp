#include "daemon/config_problems.h"

#include <fmt/core.h>

namespace framewatch::daemon {

void print_problems(const std::vector<ConfigProblem>& problems) {
  for (const ConfigProblem& p : problems) fmt::print(stderr, "{}: {}\n", p.where, p.message);
}

}  // namespace framewatch::daemon
