#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "daemon/config.h"
#include "daemon/estimation.h"
#include "daemon/once_a_second.h"

namespace framewatch::daemon {

/// Notices, while the program runs, that [gap] model was put in place or exchanged, and lets the
/// gap monitor adopt it. A file that is no model of the building is told once and left alone.
class GapKeeper {
 public:
  explicit GapKeeper(const Config& config);
  /// now_us: it looks once a second.
  void look(Estimation& estimation, std::int64_t now_us);

 private:
  const Config& config_;
  OnceASecond second_;
  std::filesystem::file_time_type seen_{};
};

}  // namespace framewatch::daemon
