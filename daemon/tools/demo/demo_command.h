// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct DemoArguments {
  double seconds = 300;
  int building = 2;  ///< stories: 2 with a channel everywhere, or 20 with channels on five levels
  bool quiet = false;
  int port = 8080;     ///< port of the page; any free one if it is taken
  std::string report;  ///< report to write at the end; empty for none
  std::string can;     ///< CAN interface of the samples; empty for LCM
};

/// Runs `framewatch demo`: simulates the two-story table of configs/scenario_table_two_story.toml
/// in real time. Messages, estimates, the table on the screen and the live page use LCM; samples
/// may use a CAN bus. After 20 s one frame loses 15 % of its stiffness; of twenty stories five lose
/// 20 % in one frame. Returns 0 if the stiffnesses are found within the limits of DemoView.
int demo(const DemoArguments& arguments);

}  // namespace framewatch::daemon
