#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/base/clocks.h"
#include "daemon/monitor/live/live_estimation.h"

namespace framewatch::daemon {

/// Logs once a second at most which messages and samples were lost or rejected since the last line.
class IntakeWarnings {
 public:
  void look(const LiveEstimation& live, std::int64_t now_us);

 private:
  static void add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what,
                  const std::string& of = "");

  OnceASecond second_;
  std::int64_t seen_[13] = {};
  std::vector<std::int64_t> rejected_;  ///< by axis
  bool said_unbound_ = false;
};

}  // namespace framewatch::daemon
