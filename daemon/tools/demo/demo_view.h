// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/monitor/estimates/estimate_table.h"
#include "drivers/lcm/lcm_source.h"

namespace framewatch::daemon {

/// Prints the progress of the demo: a live table on a terminal, else a line now and then and the
/// table at the end. It knows the estimates only from the messages it receives.
class DemoView {
 public:
  static constexpr double kFrameLimit_ratio = 0.01;
  static constexpr double kPanelLimit_ratio = 0.05;

  /// `truth`: true values by parameter name, SI.
  DemoView(std::map<std::string, double> truth, bool terminal, bool quiet);

  /// Sets the truth that the estimates are compared with from now on.
  void set_truth(std::map<std::string, double> truth);
  /// Returns the LCM channels of message().
  static std::vector<std::string> channels(const std::string& prefix);
  void message(const drivers::LcmMessage& message);
  /// Draws if it is time to. `elapsed_s` of `total_s` have passed.
  void update(double elapsed_s, double total_s);
  /// Prints the table and whether the newest window's stiffnesses are within the limits. Exit code.
  int finish();

 private:
  void parameters(const drivers::LcmMessage& message);
  void estimate(const drivers::LcmMessage& message);
  std::string state() const;
  /// Draws over the previous picture.
  void draw(const std::string& last_line);

  std::map<std::string, double> truth_by_name_;
  bool terminal_, quiet_;
  std::optional<framewatch::parameter_table_t> table_;
  framewatch::window_estimate_t estimate_{};
  std::vector<double> truth_;  ///< in the table's order
  std::int64_t windows_ = 0;
  std::int64_t valid_ = 0;
  std::int64_t lost_ = 0;            ///< lost messages, by jumps of the sequence
  std::int64_t next_sequence_ = -1;  ///< -1 before the first message
  double worst_frame_ratio_ = 0;     ///< of all valid windows
  double worst_panel_ratio_ = 0;
  double next_draw_s_ = 0;
  std::size_t lines_drawn_ = 0;
};

}  // namespace framewatch::daemon
