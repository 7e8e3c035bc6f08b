// SPDX-License-Identifier: MIT
// TOML files: configuration, scenario, expectation, baseline.
#include "daemon/config/learned_files.h"
#include "daemon/tools/replay/expectation.h"
#include "daemon/tools/simulation/scenario.h"
#include "estimator/structure/parameter_table.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using Problems = std::vector<daemon::ConfigProblem>;

void require_answer(bool read, const Problems& problems) {
  require(read == problems.empty(), "a value or a problem");
}

const estimator::ParameterTable& example_parameters() {
  static const estimator::ParameterTable table(example_building().pipeline.structure);
  return table;
}

/// Paths in the file point to a place without files.
void read_configuration(Bytes input) {
  const std::string text = text_of(input);
  Problems problems;
  const bool read = daemon::parse_config("/nowhere/fuzz.toml", text, problems).has_value();
  require_answer(read, problems);
  Problems of_model;
  require_answer(
      daemon::parse_gap_model(example_building(), "/nowhere/fuzz.toml", text, of_model).has_value(),
      of_model);
}

std::vector<std::string> configuration_seeds() {
  std::vector<std::string> out{kExampleBuilding};
  for (const char* name : {"mini_shake_table_xsens", "paper_table1", "table_two_story",
                           "can/raw_int16", "can/vehicle", "can/xsens_mti600", "can/fd_block"})
    out.push_back(repository_file(std::string("configs/") + name + ".toml"));
  return out;
}

void read_a_scenario(Bytes input) {
  Problems problems;
  require_answer(
      daemon::read_scenario(text_of(input), "/nowhere/fuzz.toml", problems, &example_building())
          .has_value(),
      problems);
}

std::vector<std::string> scenario_seeds() {
  std::vector<std::string> out{repository_file("tests/golden/scenario.toml")};
  for (const char* name :
       {"cubic_first_story", "hidden_bouc_wen", "loose_sensor", "paper_table1", "table_two_story"})
    out.push_back(repository_file("configs/scenario_" + std::string(name) + ".toml"));
  out.push_back(repository_file("configs/can/scenario_tower.toml"));
  return out;
}

void read_expectation(Bytes input) {
  const InputFile file(input);
  Problems problems;
  require_answer(daemon::load_expectations(file.path(), example_parameters(), problems).has_value(),
                 problems);
}

std::vector<std::string> expectation_seeds() {
  return {repository_file("tests/golden/expected.toml"),
          "reason = \"r\"\n[counts]\nlost = { min = 1, max = 2 }\n[[parameter]]\n"
          "name = \"k*\"\nvalue = 1e4\ntolerance = 2.0\nfrom_s = 1\nto_s = 2\n[[event]]\n"
          "kind = \"gap\"\nplace = \"base-x\"\ncount = 2\n"};
}

void read_baseline(Bytes input) {
  const InputFile file(input);
  Problems problems;
  const auto baseline = daemon::load_baseline(file.path(), example_parameters(), problems);
  require_answer(baseline.has_value(), problems);
  if (baseline)
    (void)daemon::extended_baseline_text(text_of(input), *baseline, *baseline,
                                         example_parameters());
}

std::vector<std::string> baseline_seeds() {
  std::string text;
  for (const auto& name : {"kx_1_y1", "ky_1_x1"})
    text += std::string("[[parameter]]\nname = \"") + name +
            "\"\nvalue = 34000.0\nstd_error = 10.0\nunit = \"N/m\"\ntemperature_degc = 7.5\n\n";
  return {text};
}

}  // namespace

const FuzzTarget kConfigTarget{"config", &read_configuration, &configuration_seeds};
const FuzzTarget kScenarioTarget{"scenario", &read_a_scenario, &scenario_seeds};
const FuzzTarget kExpectationTarget{"expectation", &read_expectation, &expectation_seeds};
const FuzzTarget kBaselineTarget{"baseline", &read_baseline, &baseline_seeds};

}  // namespace framewatch::test
