#include "daemon/demo/demo_scenario.h"

#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "daemon/config/sections/config_problems.h"
#include "daemon/lab/demo_files.h"

namespace framewatch::daemon {

Scenario demo_scenario() {
  std::vector<ConfigProblem> problems;
  const auto config = parse_config("built-in configuration", kDemoConfig, problems);
  std::optional<Scenario> scenario;
  if (config) scenario = read_scenario(kDemoScenario, "built-in scenario", problems, &*config);
  if (scenario) return *std::move(scenario);
  print_problems(problems);
  std::abort();
}

std::map<std::string, double> truth_of(const Scenario& s, const Eigen::VectorXd& theta) {
  const estimator::ParameterTable table(s.config.pipeline.structure);
  std::map<std::string, double> out;
  for (int i = 0; i < table.size(); ++i) out[table[i].name] = theta[i];
  return out;
}

}  // namespace framewatch::daemon
