// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulate_command.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/progress.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulated_history.h"
#include "daemon/tools/simulation/simulation.h"
#include "daemon/tools/simulation/simulation_output.h"
#include "daemon/tools/simulation/simulation_truth.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"
#include "drivers/lcm/lcm_provider.h"

namespace framewatch::daemon {
namespace {

std::string simulate_history(const Scenario& scenario, const SimulateArguments& a) {
  const std::int64_t count = hours(scenario);
  std::string problem;
  {
    Progress progress("simulate", count, "hours", 1, a.quiet);
    problem = write_simulated_history(scenario, a.history, a.weather,
                                      [&](std::int64_t done) { progress(done); });
  }
  if (problem.empty() && !a.quiet)
    fmt::print(stderr, "{}: {} hours to {}\n", scenario.config.pipeline.structure.name, count,
               a.history);
  return problem;
}

}  // namespace

int simulate(const SimulateArguments& a) {
  const bool motion = !a.out.empty() || a.lcm || a.can;
  if (!motion && a.history.empty())
    return refuse("simulate",
                  "nowhere to put it: --out FILE, --lcm, --can, --history FOLDER or several");
  if (a.history.empty() && !a.weather.empty())
    return refuse("simulate", "--weather goes with --history");
  std::vector<ConfigProblem> problems;
  std::optional<Scenario> scenario = load_scenario(a.scenario, problems);
  print_problems(problems);
  if (!scenario) return kBadInput;
  if (a.seconds > 0) scenario->duration_s = a.seconds;
  if (!a.history.empty()) {
    const std::string problem = simulate_history(*scenario, a);
    if (!problem.empty()) return refuse("simulate", problem);
    if (!motion) return 0;
  }
  if (const std::string problem = size_problem(*scenario); !problem.empty())
    return refuse("simulate", fmt::format("{}: {}", a.scenario, problem));

  std::unique_ptr<drivers::LcmProvider> lcm;
  std::vector<std::unique_ptr<SimulationOutput>> outputs;
  std::string error;
  if (!a.out.empty()) {
    outputs.push_back(file_output(*scenario, a.out, error));
    if (!outputs.back()) return refuse("simulate", fmt::format("{}: {}", a.out, error));
  }
  drivers::TextOutput truth;
  if (!a.truth.empty() && !truth.open(a.truth))
    return refuse("simulate", fmt::format("{}: {}", a.truth, truth.error()));
  if (a.lcm) {
    const std::string& url = a.lcm_url.empty() ? scenario->config.lcm.url : a.lcm_url;
    lcm = drivers::open_lcm(url, scenario->config.lcm.reception, error);
    if (!lcm) return refuse("simulate", error);
    outputs.push_back(live_output(*scenario, *lcm, a.speed));
  }

  if (a.can) {
    outputs.push_back(can_output(*scenario, a.can_interface, a.speed, error));
    if (!outputs.back()) return refuse("simulate", error);
  }

  const std::int64_t count = instants(*scenario);
  {
    Progress progress("simulate", count, "instants", 1, a.quiet);
    const std::string problem =
        run_simulation(*scenario, a.scenario, outputs, [&](std::int64_t done) { progress(done); });
    if (!problem.empty()) return refuse("simulate", problem);
  }
  if (!a.truth.empty() && !(truth.write(truth_json(*scenario)) && truth.close()))
    return refuse("simulate", fmt::format("{}: {}", a.truth, truth.error()));
  if (!a.quiet)
    fmt::print(stderr, "{}: {} channels, {} instants at {:g} Hz{}{}\n",
               scenario->config.pipeline.structure.name, scenario->config.pipeline.axes.size(),
               count, scenario->rate_hz, a.out.empty() ? "" : " to ",
               a.out == drivers::kStandardOutput ? "standard output" : a.out);
  return 0;
}

}  // namespace framewatch::daemon
