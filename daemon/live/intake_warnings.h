#pragma once

#include <cstdint>
#include <string>

#include "daemon/base/once_a_second.h"
#include "daemon/estimation/estimation.h"

namespace framewatch::daemon {

/// Logs once a second at most which messages and samples were lost or rejected since the last line.
class IntakeWarnings {
 public:
  void look(const Estimation& estimation, const LiveState& state, std::int64_t now_us);

 private:
  static void add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what);

  OnceASecond second_;
  std::int64_t seen_[8] = {};
  bool said_unbound_ = false;
};

}  // namespace framewatch::daemon
