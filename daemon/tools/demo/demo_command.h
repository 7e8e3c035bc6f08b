#pragma once

#include <string>

namespace framewatch::daemon {

struct DemoArguments {
  double seconds = 300;
  int building = 2;  ///< stories: 2, a table with a channel everywhere; 20, on five levels
  bool quiet = false;
  int port = 8080;     ///< of the page; any free one when it is taken
  std::string report;  ///< page to write at the end; empty: none
  std::string can;     ///< interface that carries the samples; empty: LCM does
};

/// framewatch demo: the two-story table of configs/scenario_table_two_story.toml is shaken in real
/// time; its sensors' messages, the estimates, the table on the screen and the live page all go
/// over LCM, or the samples as frames over a CAN bus. After 20 s one frame loses 15 % of its
/// stiffness; of twenty stories five lose 20 % in one frame. Exit code: 0 when the stiffnesses are
/// found within the limits of DemoView.
int demo(const DemoArguments& arguments);

}  // namespace framewatch::daemon
