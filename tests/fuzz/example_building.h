// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "daemon/config/config.h"
#include "tests/fuzz/input.h"

namespace framewatch::test {

/// One story, one bay each way, watched, with every axis on LCM; small, so that an execution is
/// short.
inline const std::string kExampleBuilding = R"([structure]
stories = 1
frames_x = ["y1", "y2"]
frames_y = ["x1", "x2"]
span_x_m = [1.0]
span_y_m = [1.0]
story_height_m = [1.0]
node_mass_kg = 20.0

[estimator]
rate_hz = 50.0
window_s = 1.0
other_windows_s = [2.0]

[watch]
learn_s = 2.0
quiet_window_s = 0
temperature_channel = "TEMPERATURE"

[gap]
learn_s = 2.0
window_s = 1

[[channel]]
name = "base-x"
story = 0
direction = "x"
source = { lcm = "ACCEL", node = 0, axis = "x" }

[[channel]]
name = "base-y"
story = 0
direction = "y"
source = { lcm = "ACCEL", node = 0, axis = "y" }

[[channel]]
name = "F1-Y1"
story = 1
frame = "y1"
source = { lcm = "ACCEL", node = 1, axis = "x" }

[[channel]]
name = "F1-Y2"
story = 1
frame = "y2"
source = { lcm = "ACCEL", node = 1, axis = "y" }

[[channel]]
name = "F1-X1"
story = 1
frame = "x1"
source = { lcm = "ACCEL", node = 1, axis = "z" }

[[channel]]
name = "F1-X2"
story = 1
frame = "x2"
)";

/// The configuration in a text, which must be valid.
inline daemon::Config valid_config(const std::string& path, const std::string& text) {
  std::vector<daemon::ConfigProblem> problems;
  auto config = daemon::parse_config(path, text, problems);
  for (const daemon::ConfigProblem& p : problems) require(false, (p.where + p.message).c_str());
  require(config.has_value(), "a valid configuration");
  return std::move(*config);
}

inline const daemon::Config& example_building() {
  static const daemon::Config config = valid_config("building.toml", kExampleBuilding);
  return config;
}

}  // namespace framewatch::test
