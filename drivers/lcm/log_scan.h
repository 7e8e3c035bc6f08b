#pragma once

#include <cstdint>
#include <string>

#include "drivers/files/input_file.h"

namespace framewatch::drivers {

/// What an event of a log begins with.
struct LogEventHeader {
  std::int64_t number, timestamp_us;
  std::int64_t channel_length, payload_length;
  std::int64_t end;  ///< offset after the event
};

/// Looks for events in a log, at ascending offsets, through a window of its own.
class LogScan {
 public:
  static constexpr std::int64_t kHeaderBytes = 28;
  static constexpr std::int32_t kMaxChannel = 63;
  static constexpr std::int32_t kMaxPayload = 16 * 1024 * 1024;

  /// `error` gets what the system refuses.
  LogScan(InputFile& file, std::string& error) : file_(file), error_(error), window_(file) {}

  void clear();
  /// `bytes` bytes at `offset`, valid until the next call of anything; null when unreadable.
  const std::uint8_t* at(std::int64_t offset, std::int64_t bytes) {
    return window_.at(offset, bytes, error_);
  }
  /// Whether a sync word, or as much of one as fits into the file, is at `offset`.
  bool sync_at(std::int64_t offset);
  /// Offset of the first sync word in [from, limit), or limit.
  std::int64_t find_sync(std::int64_t from, std::int64_t limit);
  /// Whether a header with acceptable lengths and channel is at `offset`; `why` not, when not null.
  bool read_header(std::int64_t offset, LogEventHeader& header, const char** why);
  /// Whether a sync word or the end of the file follows.
  bool well_followed(const LogEventHeader& header);

  /// Bytes that were looked at, as often as they were.
  std::int64_t examined_bytes() const { return examined_bytes_ + window_.bytes_read(); }

 private:
  InputFile& file_;
  std::string& error_;
  FileWindow window_;
  std::int64_t examined_bytes_ = 0;
};

/// Whether the first bytes of a file are a sync word.
bool begins_with_sync(const std::uint8_t* bytes);

}  // namespace framewatch::drivers
