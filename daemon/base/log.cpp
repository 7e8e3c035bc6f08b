#include "daemon/base/log.h"

#include <cstdio>
#include <cstdlib>

#include <fmt/core.h>

namespace framewatch::daemon {

void log(LogLevel level, const std::string& message) {
  static const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  if (journal)
    fmt::print(stderr, "<{}>framewatch: {}\n", static_cast<int>(level), message);
  else
    fmt::print(stderr, "framewatch: {}\n", message);
}

void RateLimitedLog::operator()(std::int64_t now_us, const std::string& message) {
  if (now_us < next_us_) {
    ++held_back_;
    return;
  }
  next_us_ = now_us + 1'000'000;
  if (held_back_ > 0)
    log(level_, fmt::format("{} ({} more like it)", message, held_back_));
  else
    log(level_, message);
  held_back_ = 0;
}

}  // namespace framewatch::daemon
