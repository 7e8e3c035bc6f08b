// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"

namespace framewatch::test {

/// One story, one bay each way, with only the required keys.
inline constexpr const char* kGoodConfig = R"([structure]
stories = 1
frames_x = ["y1", "y2"]
frames_y = ["x1", "x2"]
span_x_m = [1.0]
span_y_m = [1.0]
story_height_m = [1.0]
node_mass_kg = 20.0

[[channel]]
name = "base-x"
story = 0
direction = "x"

[[channel]]
name = "base-y"
story = 0
direction = "y"

[[channel]]
name = "F1-Y1"
story = 1
frame = "y1"
source = { lcm = "ACCEL", node = 2, axis = "x" }

[[channel]]
name = "F1-Y2"
story = 1
frame = "y2"

[[channel]]
name = "F1-X1"
story = 1
frame = "x1"

[[channel]]
name = "F1-X2"
story = 1
frame = "x2"

)";

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) ADD_FAILURE() << "no '" << what << "' in the text";
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

inline std::string told(const std::vector<daemon::ConfigProblem>& problems) {
  std::string all;
  for (const daemon::ConfigProblem& p : problems) all += p.where + ": " + p.message + "\n";
  return all;
}

inline daemon::Config good(const std::string& text) {
  std::vector<daemon::ConfigProblem> problems;
  const auto config = daemon::parse_config("c.toml", text, problems);
  EXPECT_TRUE(config) << told(problems);
  return config.value_or(daemon::Config{});
}

}  // namespace framewatch::test
