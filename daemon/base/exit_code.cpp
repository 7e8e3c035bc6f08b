#include "daemon/base/exit_code.h"

#include <cstdio>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "daemon/base/terminal_colour.h"

namespace framewatch::daemon {

int refuse(const std::string& command, const std::string& message) {
  fmt::print(stderr, "{} {}\n", toned(Tone::bad, "framewatch " + command + ":", stderr),
             printable_lines(message));
  return kBadInput;
}

}  // namespace framewatch::daemon
