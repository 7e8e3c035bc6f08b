// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/text_output.h"

namespace framewatch::drivers {

/// Takes a frame of a log and the name of its interface.
using TakeCanFrame = std::function<void(const CanFrame&, std::string_view interface)>;

/// Parses a line as `candump -l` writes it: "(1631416514.717133) can0 0D0#A8FF00000000FF01". The
/// stamp has six decimals, or nine (`candump -l -N`), of which six are used. Ids of eight digits
/// have 29 bits. "##" with a digit of flags marks CAN FD and "#R" a remote frame; the flag 20000000
/// in an id marks an error frame. Returns false and sets `rule` to the rule that the line breaks.
bool parse_candump_line(std::string_view line, CanFrame& frame, std::string_view& interface,
                        std::string& rule);

/// Returns the line that `candump -l` would write, without a line end.
std::string candump_line(const CanFrame& frame, std::string_view interface);

/// Returns true if one of the first ten lines of a file is of a `candump -l` log.
bool looks_like_candump(const std::string& path);

/// Calls `take` for every frame of a `candump -l` log, plain or gzip, with the name of its
/// interface. Returns false when there was a problem. Skips remarks, which begin with #, and lines
/// that are not frames, and appends a problem at path:line for the first 20 of the latter.
bool read_candump(const std::string& path, const TakeCanFrame& take,
                  std::vector<Problem>& problems);

/// Writes frames as `candump -l` does. The file is PATH.partial until close(). Each function
/// returns false and sets error() when the system refuses.
class CanLogWriter {
 public:
  [[nodiscard]] bool open(const std::string& path) { return out_.open(path); }
  [[nodiscard]] bool write(const CanFrame& frame, std::string_view interface);
  [[nodiscard]] bool close() { return out_.close(); }
  const std::string& error() const { return out_.error(); }

 private:
  TextOutput out_;
};

}  // namespace framewatch::drivers
