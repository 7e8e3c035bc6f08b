// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "drivers/files/durable_file.h"

namespace framewatch::daemon {

/// raw: samples and their tables; frame: of a CAN bus; estimate: messages of the estimator.
enum class MessageKind { raw, frame, estimate };

/// A message as it was received; a CAN frame as a line of candump.
struct KeptMessage {
  MessageKind kind;
  std::int64_t received_us;  ///< host clock
  std::string channel;
  std::string bytes;
};

/// Keeps the messages of the last seconds, for the time before a trigger. Bounded in time and
/// bytes.
class MessageRing {
 public:
  MessageRing(double seconds, std::size_t bytes)
      : span_us_(static_cast<std::int64_t>(1e6 * seconds)), most_bytes_(bytes) {}

  void push(KeptMessage message);
  const std::deque<KeptMessage>& messages() const { return messages_; }
  void clear();

 private:
  static std::size_t cost(const KeptMessage& message);
  void drop_oldest();

  std::int64_t span_us_;
  std::size_t most_bytes_, bytes_ = 0;
  std::deque<KeptMessage> messages_;
};

/// Names of the files in a session's folder.
inline constexpr const char* kRawLog = "raw.lcmlog";
inline constexpr const char* kCanLog = "raw.can.log";
inline constexpr const char* kEstimatesLog = "estimates.lcmlog";
/// Estimates computed again from the raw log, where those of kEstimatesLog are missing.
inline constexpr const char* kReplayedLog = "estimates-replayed.lcmlog";
inline constexpr const char* kSessionJson = "session.json";
inline constexpr const char* kReportPage = "report.html";

/// Writes the logs of a running session, each with its own queue and thread, so that a log of
/// estimates that cannot be written does not delay the raw samples.
class SessionLog {
 public:
  /// Creates the logs. Returns false and sets `error` when one cannot be created.
  [[nodiscard]] bool open(const std::string& folder, bool lcm, bool can, std::string& error);
  void write(const KeptMessage& message);

  std::int64_t messages() const { return messages_; }
  std::int64_t dropped() const;
  std::int64_t bytes() const;
  /// Returns why the queued messages cannot be written; "" when they can.
  std::string trouble() const;
  /// Appends the files that are complete to `files` and the failures to `problems`.
  void close(std::vector<std::string>& files, std::vector<std::string>& problems);

 private:
  drivers::DurableFile raw_, can_, estimates_;
  std::int64_t messages_ = 0, raw_events_ = 0, estimate_events_ = 0;
  std::string event_;
};

}  // namespace framewatch::daemon
