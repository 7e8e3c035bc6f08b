#include "daemon/tools/commands/lost_headers.h"

#include <cstddef>

#include <fmt/core.h>

namespace framewatch::daemon {

std::string lost_headers(const drivers::Record& record, const std::string& out, bool has_names) {
  constexpr std::size_t kNamed = 10;
  std::string names;
  std::size_t count = 0;
  for (std::size_t c = 0; c < record.headers.size(); ++c) {
    if (record.headers[c] == drivers::AxisHeader{}) continue;
    if (count++ < kNamed) names += (names.empty() ? "" : ", ") + record.names[c];
  }
  if (count == 0) return {};
  if (count > kNamed) names += fmt::format(" and {} more", count - kNamed);
  return fmt::format(
      "{} does not keep what the headers say of {}: {}direction, place and unit; framewatch init "
      "--record makes a configuration of the same files, and convert --config holds them against "
      "one",
      out, names, has_names ? "" : "name (nodes are numbered in the order of the files), ");
}

}  // namespace framewatch::daemon
