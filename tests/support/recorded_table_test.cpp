// SPDX-License-Identifier: MIT
#include "tests/support/recorded_table_test.h"

#include <stdexcept>

#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation_output.h"

namespace framewatch::test {

std::string table_config() {
  return FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
}

void record_table_test(const std::string& path, double duration_s) {
  std::vector<daemon::ConfigProblem> problems;
  auto scenario = daemon::load_scenario(
      FRAMEWATCH_SOURCE_DIR "/configs/scenario_table_two_story.toml", problems);
  if (!scenario) throw std::runtime_error(problems.front().message);
  scenario->duration_s = duration_s;
  std::string error;
  const auto output = daemon::file_output(*scenario, path, error);
  if (!output) throw std::runtime_error(error);
  daemon::Simulation simulation(*scenario);
  for (std::int64_t i = 0; i < daemon::instants(*scenario); ++i) {
    const std::vector<double>& raw = simulation.next();
    if (!output->put(simulation.time_s(), raw)) throw std::runtime_error(output->error());
  }
  if (!output->close()) throw std::runtime_error(output->error());
}

}  // namespace framewatch::test
