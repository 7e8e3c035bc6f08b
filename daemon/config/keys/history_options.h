// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// [history]: data that `framewatch run` keeps on disk, docs/history.md.
struct HistorySettings {
  std::string directory;
  double rotate_s = 3600, rotate_mb = 64;  ///< limits of a raw log, whichever comes first
  double keep_days = 30, keep_gb = 20;     ///< limits of all raw logs
  bool compress = true;
  double resolution_mps2 = 1e-6;                       ///< one count
  double event_before_s = 60, event_after_s = 120;     ///< raw samples kept forever around events
  std::vector<std::int64_t> summary_s{60, 600, 3600};  ///< ascending, each a multiple of the last
  double keep_summary_days = 400;                      ///< for the shortest summaries
};

}  // namespace framewatch::daemon
