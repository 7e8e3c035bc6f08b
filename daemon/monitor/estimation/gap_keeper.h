#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

/// Notices that the file of [gap] model was created or exchanged while the program runs, and gives
/// it to the gap monitor. A file that does not fit the building is reported once and ignored.
class GapKeeper {
 public:
  explicit GapKeeper(const Config& config);
  /// Continues with another configuration; only its [gap] may differ.
  void reconfigure(const Config& config) { config_ = &config; }
  /// Looks once a second; now_us: host clock.
  void look(Estimation& estimation, std::int64_t now_us);

 private:
  const Config* config_;
  OnceASecond second_;
  std::filesystem::file_time_type seen_{};
};

}  // namespace framewatch::daemon
