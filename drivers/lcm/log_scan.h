// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "drivers/files/input_file.h"

namespace framewatch::drivers {

/// The header of an event in a log.
struct LogEventHeader {
  std::int64_t number, timestamp_us;
  std::int64_t channel_length, payload_length;
  std::int64_t end;  ///< offset after the event
};

/// Looks for events in a log at ascending offsets, through its own window.
class LogScan {
 public:
  static constexpr std::int64_t kHeaderBytes = 28;
  static constexpr std::int32_t kMaxChannel = 63;
  static constexpr std::int32_t kMaxPayload = 16 * 1024 * 1024;

  /// Sets `error` when the system refuses a read. `file` and `error` must outlive this object.
  LogScan(InputFile& file, std::string& error) : file_(file), error_(error), window_(file) {}

  void clear();
  /// Returns `bytes` bytes at `offset`, valid until the next call of any function; null when
  /// unreadable.
  const std::uint8_t* at(std::int64_t offset, std::int64_t bytes) {
    return window_.at(offset, bytes, error_);
  }
  /// Returns true if a sync word, or its beginning at the end of the file, is at `offset`.
  bool sync_at(std::int64_t offset);
  /// Returns the offset of the first sync word in [from, limit), or limit.
  std::int64_t find_sync(std::int64_t from, std::int64_t limit);
  /// Reads the header at `offset`. Returns false, and sets `why` unless it is null, when there is
  /// no header with valid lengths and channel.
  bool read_header(std::int64_t offset, LogEventHeader& header, const char** why);
  /// Returns true if a sync word or the end of the file follows the event.
  bool well_followed(const LogEventHeader& header);

  /// Returns the bytes examined, counting bytes as often as they were examined.
  std::int64_t examined_bytes() const { return examined_bytes_ + window_.bytes_read(); }

 private:
  InputFile& file_;
  std::string& error_;
  FileWindow window_;
  std::int64_t examined_bytes_ = 0;
};

/// Returns true if the first four bytes of a file are a sync word.
bool begins_with_sync(const std::uint8_t* bytes);

/// Holds stretches [start, end) of a file by ascending start. Tells for the first one whether
/// another begins inside it and reaches past its end. Takes constant time per stretch on average
/// (next greater elements by a monotonic stack).
class OverlapScan {
 public:
  static constexpr std::int64_t kNone = INT64_MAX;

  void clear();
  /// Adds a stretch that starts after those before.
  void add(std::int64_t start, std::int64_t end);
  /// Drops the stretches that begin before `offset`.
  void drop_before(std::int64_t offset);
  /// Returns the start of the first stretch that ends after the front one; kNone when there is no
  /// such stretch.
  std::int64_t reached_over_at() const { return open_.empty() ? kNone : open_.front().over; }

 private:
  struct Candidate {
    std::int64_t start, end;
    std::int64_t over = kNone;  ///< start of the first later stretch that ends after `end`
  };
  std::deque<Candidate> open_;
  std::int64_t dropped_ = 0;       ///< dropped so far; numbers of stretches count on
  std::deque<std::int64_t> ends_;  ///< numbers of stretches without `over`, by descending end
};

}  // namespace framewatch::drivers
