#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Who acknowledged an event, and when.
struct Acknowledgement {
  std::int64_t time_us = 0;  ///< host clock
  std::string who, comment;

  template <typename Archive>
  void archive(Archive& a) {
    a(time_us, who, comment);
  }
};

}  // namespace framewatch::daemon
