#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// Somebody knows of an event.
struct Acknowledgement {
  std::int64_t time_us = 0;  ///< host clock
  std::string who, comment;

  template <typename Archive>
  void archive(Archive& a) {
    a(time_us, who, comment);
  }
};

}  // namespace framewatch::daemon
