// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::earthquake {

enum class AnnouncementState { cleared, raised, changed };

/// One statement of the program about one element at one instant. An event that names several
/// elements becomes several statements.
struct Announcement {
  double at_s = 0;      ///< newest sample at the time of the statement
  std::int64_t id = 0;  ///< of the event, the same from raised to cleared
  AnnouncementState state = AnnouncementState::raised;
  int parameter = -1;               ///< theta order; -1: the whole building
  bool sized = true;                ///< false: "is changing", without a number
  double ratio = 0, std_error = 0;  ///< relative to the baseline; undefined if not sized
};

/// Runs the daemon's estimation in this process on live samples and reads its statements about
/// changes. This is the only part of the study that parses them: if events change, change
/// announcements.cpp.
class Announcer : private daemon::EstimationListener {
 public:
  /// The baseline is learned from the motion. `config` must be valid; its long window is switched
  /// off.
  Announcer(const estimator::PipelineConfig& config, const estimator::WatchOptions& options);

  void push(const estimator::AccelSample& sample);
  /// Ends the input.
  void finish();
  const std::vector<Announcement>& said() const { return said_; }
  /// Returns true if the baseline of a parameter is learned.
  bool knows(int parameter) const;
  /// Returns true if a parameter is watched for changes.
  bool watched(int parameter) const { return watched_[static_cast<std::size_t>(parameter)]; }
  const estimator::ParameterTable& table() const { return table_; }

 private:
  void on_event(const event_t& event) override;

  daemon::Config config_;
  estimator::ParameterTable table_;
  std::vector<bool> watched_;
  daemon::Estimation estimation_;
  double now_s_ = 0;
  std::vector<Announcement> said_;
};

}  // namespace framewatch::earthquake
