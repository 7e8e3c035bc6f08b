#include "daemon/tools/commands/selftest_command.h"

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/config/sections/config_problems.h"

namespace framewatch::daemon {
namespace {

void print_text(const std::vector<MachineCheck>& checks) {
  for (const MachineCheck& check : checks) {
    fmt::print("{} {:<10} {}\n",
               check.good ? toned(Tone::good, "ok  ", stdout) : toned(Tone::bad, "bad ", stdout),
               check.name, check.found);
    if (!check.good) fmt::print("{:15} -> {}\n", "", check.remedy);
  }
}

void print_json(const std::vector<MachineCheck>& checks) {
  nlohmann::json out = nlohmann::json::array();
  for (const MachineCheck& check : checks)
    out.push_back({{"check", check.name},
                   {"good", check.good},
                   {"found", check.found},
                   {"remedy", check.remedy}});
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

int selftest(const SelftestArguments& a) {
  LcmSettings lcm;
  if (!a.config.empty()) {
    std::vector<ConfigProblem> problems;
    const auto config = load_config(a.config, problems);
    print_problems(problems);
    if (!config) return kBadInput;
    lcm = config->lcm;
  }
  const std::vector<MachineCheck> checks{check_multicast(lcm), check_buffer(lcm), check_clock(),
                                         check_estimate(), check_disk(a.directory)};
  if (a.json)
    print_json(checks);
  else
    print_text(checks);
  const bool good =
      std::all_of(checks.begin(), checks.end(), [](const MachineCheck& c) { return c.good; });
  return good ? 0 : kFailed;
}

}  // namespace framewatch::daemon
