// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <string>
#include <vector>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Notices that the file of [gap] model was created or replaced while the program runs, and passes
/// it to the gap monitor. Reports a file that does not fit the building once and ignores it.
class GapKeeper {
 public:
  /// `config` must outlive this, or be replaced by reconfigure().
  explicit GapKeeper(const Config& config);
  /// Continues with another configuration, of which only [gap] may differ.
  void reconfigure(const Config& config) { config_ = &config; }
  /// Checks the file once a second; `now_us`: host clock.
  void poll(Estimation& estimation, std::int64_t now_us);

 private:
  const Config* config_;
  OnceASecond second_;
  std::filesystem::file_time_type seen_{};
};

/// Keeps the newest raw samples in memory and, when a gap is raised, writes those around it as an
/// LCM event log. A thread writes PATH.partial and renames it, so that a slow disk does not delay
/// estimates. GapSettings::before_s and after_s limit its size.
class GapSegments {
 public:
  /// `config` must outlive this.
  explicit GapSegments(const Config& config);
  /// Writes the segment of a gap whose samples are still incomplete.
  ~GapSegments();

  void sample(const estimator::AccelSample& sample);
  /// Tells that the gap with this id was raised: its segment is written when it is complete.
  void raised(std::int64_t gap_id);

 private:
  void write();

  const Config& config_;
  std::vector<estimator::AccelSample> ring_;
  std::size_t next_ = 0, held_ = 0;
  std::int64_t newest_us_ = INT64_MIN;
  std::int64_t waiting_ = 0;  ///< gap whose samples are still coming; 0: no gap
  std::int64_t raised_us_ = 0;
  std::future<void> writing_;  ///< of std::async: its destructor waits
};

}  // namespace framewatch::daemon
