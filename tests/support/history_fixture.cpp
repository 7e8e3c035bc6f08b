// SPDX-License-Identifier: MIT
#include "tests/support/history_fixture.h"

#include <stdexcept>

#include "tests/support/recorded_table_test.h"

namespace framewatch::test {

daemon::Config table_with_history(const std::string& directory) {
  std::vector<daemon::ConfigProblem> problems;
  auto config = daemon::load_config(table_config(), problems);
  if (!config) throw std::runtime_error(problems.front().message);
  config->history.emplace();
  config->history->directory = directory;
  config->history->summary_s = {1, 2, 4};
  return *config;
}

std::vector<daemon::RawCount> raw_counts(const std::string& directory, std::int64_t from_us,
                                         std::int64_t to_us) {
  std::vector<daemon::RawCount> out;
  std::vector<std::string> notes;
  std::string problem;
  const daemon::RawVisitor visitor{[](const std::vector<std::string>&, double) {},
                                   [&](const daemon::RawCount& count) { out.push_back(count); }};
  if (!daemon::read_raw_history(daemon::raw_logs_between(directory, from_us, to_us), from_us, to_us,
                                visitor, notes, problem))
    throw std::runtime_error(problem);
  return out;
}

}  // namespace framewatch::test
