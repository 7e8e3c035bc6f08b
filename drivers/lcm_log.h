#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace framewatch::drivers {

/// One event of an LCM event log.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t timestamp_us = 0;  ///< when it was received, host clock, microseconds
  std::string channel;
  std::vector<std::uint8_t> data;
  std::int64_t offset = 0;  ///< byte offset of its sync word in the file
};

enum class LogRead {
  event,      ///< an intact event was read
  damage,     ///< bytes were skipped to find the next event; see damage()
  truncated,  ///< the file ends inside an event; see damage()
  end,        ///< the file ends after an intact event
  error,      ///< the operating system refused a read
};

/// A stretch of the file that is no intact event.
struct LogDamage {
  std::int64_t offset = 0;
  std::int64_t bytes = 0;
  std::string reason;
};

/// Reads LCM event logs: bounded memory, resynchronising, never trusts a length it has not checked.
/// Channel length 1..63, payload at most kMaxPayload.
class LcmLogReader {
 public:
  static constexpr std::int32_t kMaxChannel = 63;
  static constexpr std::int32_t kMaxPayload = 16 * 1024 * 1024;

  LcmLogReader() = default;
  ~LcmLogReader();
  LcmLogReader(const LcmLogReader&) = delete;
  LcmLogReader& operator=(const LcmLogReader&) = delete;

  /// False when the file cannot be opened; error() says why.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] LogRead next(LogEvent& event);
  const LogDamage& damage() const { return damage_; }
  const std::string& error() const { return error_; }
  std::int64_t size() const { return size_; }
  std::int64_t position() const { return position_; }

 private:
  std::FILE* file_ = nullptr;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  LogDamage damage_;
  std::string error_;
};

/// Writes LCM event logs that lcm-logplayer plays. Event numbers count from 0.
/// The file is written as PATH.partial and renamed by close(): nothing half-written under its name.
class LcmLogWriter {
 public:
  LcmLogWriter() = default;
  ~LcmLogWriter();
  LcmLogWriter(const LcmLogWriter&) = delete;
  LcmLogWriter& operator=(const LcmLogWriter&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool write(std::int64_t timestamp_us, const std::string& channel, const void* data,
                           std::size_t size);
  /// Flushes and renames. False when anything was not written; the partial file then stays.
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

 private:
  std::FILE* file_ = nullptr;
  std::string path_;
  std::int64_t number_ = 0;
  std::string error_;
};

}  // namespace framewatch::drivers
