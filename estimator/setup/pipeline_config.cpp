// SPDX-License-Identifier: MIT
#include "estimator/setup/pipeline_config.h"

#include <algorithm>
#include <cmath>

#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {

std::vector<std::string> problems(const PipelineConfig& config) {
  std::vector<std::string> found = problems(config.structure);
  if (!found.empty()) return found;
  found = problems(config.structure, config.axes);
  const EstimatorOptions& o = config.options;
  const auto at_least = [&](const char* name, double value, double least) {
    if (!(std::isfinite(value) && value >= least))
      found.push_back(std::string(name) + ": must be at least " + std::to_string(least));
  };
  at_least("rate_hz", o.rate_hz, 1);
  at_least("window_s", o.window_s, 40 / o.rate_hz);
  for (const double s : o.other_windows_s) {
    at_least("other_windows_s", s, 8 / o.rate_hz);
    if (s > 20 * o.window_s) found.push_back("other_windows_s: must be at most 20 times window_s");
  }
  if (o.long_window_s != 0) {
    double longest = o.window_s;
    for (const double s : o.other_windows_s) longest = std::max(longest, s);
    if (!(o.long_window_s > longest))
      found.push_back("watch.quiet_window_s: must be longer than the other windows");
  }
  at_least("hop_s", o.hop_s, 0);
  at_least("boxplot_windows", o.boxplot_windows, 1);
  at_least("high_pass_hz", o.high_pass_hz, 0.001);
  at_least("filter_damping", o.filter_damping, 0.05);
  at_least("corner_ratio", o.corner_ratio, 0.1);
  for (std::size_t i = 0; i < config.group_floors.size(); ++i) {
    const int floor = config.group_floors[i];
    const std::string name = "group_floors: " + std::to_string(floor);
    if (i > 0 && floor <= config.group_floors[i - 1])
      found.push_back(name + ": floors must ascend");
    if (floor != config.structure.stories &&
        std::none_of(config.axes.begin(), config.axes.end(),
                     [&](const SensorAxis& a) { return a.story == floor && floor > 0; }))
      found.push_back(name +
                      ": no channel measures this floor, so the stories below and above it "
                      "cannot be distinguished");
  }
  if (config.design.size() > 0) {
    const ParameterTable table(config.structure);
    if (config.design.size() != table.size() || !(config.design.array() > 0).all())
      found.push_back("design: needs " + std::to_string(table.size()) + " values > 0");
  }
  return found;
}

}  // namespace framewatch::estimator
