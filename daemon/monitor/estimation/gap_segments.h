#pragma once

#include <cstdint>
#include <future>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "estimator/motion/sample.h"

namespace framewatch::daemon {

/// Keeps the newest raw samples in memory and, when a gap is raised, writes those around it as an
/// LCM event log. A thread writes PATH.partial and renames it, so that a slow disk delays no
/// estimate. Bounded by GapSettings::before_s and after_s.
class GapSegments {
 public:
  explicit GapSegments(const Config& config);
  /// Writes the segment of a gap whose samples are not yet complete.
  ~GapSegments();
  GapSegments(const GapSegments&) = delete;
  GapSegments& operator=(const GapSegments&) = delete;

  void sample(const estimator::AccelSample& sample);
  void raised(std::int64_t gap_id);

 private:
  void write();
  void finish_writing();

  const Config& config_;
  std::vector<estimator::AccelSample> ring_;
  std::size_t next_ = 0, held_ = 0;
  std::int64_t newest_us_ = INT64_MIN;
  std::int64_t waiting_ = 0;  ///< gap whose samples are still coming; 0: none
  std::int64_t raised_us_ = 0;
  std::future<void> writing_;
};

}  // namespace framewatch::daemon
