#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/can/can_frame.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/text_output.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Bytes of a candump line besides its data, about.
inline constexpr std::int64_t kCandumpLineBytes = 29;

/// Whether a file begins as a `candump -l` log does.
bool looks_like_candump(const std::string& path);

/// Gives every frame of a `candump -l` log (plain or gzip) to `take`, with the interface's name.
/// Lines that are no frame are problems at path:line, the first 20 of them, and left out. False
/// when there was a problem.
bool read_candump(const std::string& path,
                  const std::function<void(const CanFrame&, std::string_view interface)>& take,
                  std::vector<Problem>& problems);

/// Writes frames as `candump -l` does. The file is PATH.partial until close().
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
