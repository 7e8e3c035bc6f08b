#pragma once

#include <cstdint>
#include <string>

#include "daemon/estimation.h"
#include "daemon/once_a_second.h"

namespace framewatch::daemon {

/// Says once a second at most what went wrong with messages and samples since it last said so.
class IntakeComplaints {
 public:
  void look(const Estimation& estimation, const LiveState& state, std::int64_t now_us);

 private:
  static void add(std::string& news, std::int64_t& seen, std::int64_t now, const char* what);

  OnceASecond second_;
  std::int64_t seen_[8] = {};
  bool said_unbound_ = false;
};

}  // namespace framewatch::daemon
