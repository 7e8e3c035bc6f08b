#pragma once

#include "daemon/simulation.h"

namespace framewatch::daemon {

struct DemoArguments {
  double seconds = 60;
  bool quiet = false;
};

/// framewatch demo: the two-story table of configs/scenario_table_two_story.toml is shaken in real
/// time; its sensors' messages, the estimates and the table on the screen all go over LCM. Exit
/// code: 0 when the stiffnesses are found within the limits of DemoView.
int demo(const DemoArguments& arguments);

/// The built-in scenario.
Scenario demo_scenario();

}  // namespace framewatch::daemon
