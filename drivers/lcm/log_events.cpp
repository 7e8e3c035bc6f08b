#include "drivers/lcm/log_events.h"

#include <fmt/core.h>

namespace framewatch::drivers {

bool for_each_event(const std::string& path, const std::function<bool(const LogEvent&)>& take,
                    std::vector<Problem>& problems) {
  LcmLogReader log;
  if (!log.open(path)) {
    problems.push_back({path, log.error()});
    return false;
  }
  for (LogEvent event;;) {
    switch (log.next(event)) {
      case LogRead::event:
        if (!take(event)) return true;
        break;
      case LogRead::end:
        return true;
      case LogRead::error:
        problems.push_back({path, log.error()});
        return false;
      case LogRead::damage:
      case LogRead::truncated:
        problems.push_back({fmt::format("{}: byte {}", path, log.damage().offset),
                            fmt::format("{} bytes are no LCM event: {}", log.damage().bytes,
                                        log.damage().reason)});
        return false;
    }
  }
}

std::string place_of(const std::string& path, const LogEvent& event) {
  return fmt::format("{}: event {} (byte {})", path, event.number, event.offset);
}

}  // namespace framewatch::drivers
