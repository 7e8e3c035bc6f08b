#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/tools/session/message_ring.h"
#include "drivers/files/durable_file.h"

namespace framewatch::daemon {

/// Names of the files in a session's folder.
inline constexpr const char* kRawLog = "raw.lcmlog";
inline constexpr const char* kCanLog = "raw.can.log";
inline constexpr const char* kEstimatesLog = "estimates.lcmlog";
inline constexpr const char* kSessionJson = "session.json";
inline constexpr const char* kReportPage = "report.html";

/// The logs of a running session, each with its own queue and thread: a log of estimates that
/// cannot be written does not delay the raw samples.
class SessionLog {
 public:
  /// False, with the reason, when one cannot be made.
  [[nodiscard]] bool open(const std::string& folder, bool lcm, bool can, std::string& error);
  void write(const KeptMessage& message);

  std::int64_t messages() const { return messages_; }
  std::int64_t dropped() const;
  std::int64_t bytes() const;
  /// Why the queued messages cannot be written; empty when they can.
  std::string trouble() const;
  /// Appends the files that are complete to `files` and the failures to `problems`.
  void close(std::vector<std::string>& files, std::vector<std::string>& problems);

 private:
  drivers::DurableFile raw_, can_, estimates_;
  std::int64_t messages_ = 0, raw_events_ = 0, estimate_events_ = 0;
  std::string event_;
};

}  // namespace framewatch::daemon
