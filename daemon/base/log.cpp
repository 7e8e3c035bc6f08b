// SPDX-License-Identifier: MIT
#include "daemon/base/log.h"

#include <cstdio>
#include <cstdlib>

#include <fmt/core.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace {

std::string name_of_program(LogLevel level) {
  const std::string name = "framewatch:";
  if (level > LogLevel::warning) return name;
  return toned(level == LogLevel::warning ? Tone::doubtful : Tone::bad, name, stderr);
}

}  // namespace

void log(LogLevel level, const std::string& message) {
  static const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  const std::string text = printable(message);
  const std::string line = journal ? fmt::format("<{}>framewatch: {}\n", int(level), text)
                                   : fmt::format("{} {}\n", name_of_program(level), text);
  // fmt::print throws when stderr cannot be written; a daemon must continue.
  (void)std::fputs(line.c_str(), stderr);
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
