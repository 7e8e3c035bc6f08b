#pragma once

#include <cstdint>
#include <string>

namespace framewatch::daemon {

/// SQLite databases that were set aside since the start of the program.
struct SetAside {
  std::int64_t count = 0;
  std::string path;     ///< of the last one
  std::string reason;   ///< why it was
  std::string problem;  ///< why a corrupt one could not be; empty: it could
};

/// Gives a corrupt SQLite database, with its write-ahead log, the name DATABASE.corrupt-TIME, so
/// that a new one can be begun and a person can look at the old one. Of those that were set aside
/// the three largest stay: what is lost first is what has the least in it. now_us: the host's
/// clock.
void set_aside_database(const std::string& database, std::int64_t now_us, const std::string& reason,
                        SetAside& out);

}  // namespace framewatch::daemon
