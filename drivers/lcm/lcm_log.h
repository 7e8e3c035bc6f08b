#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
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
  truncated,  ///< the file ends inside an event or in zeros that a crash left; see damage()
  end,        ///< the file ends after an event or after what damage() told
  error,      ///< the operating system refused a read; see error()
};

/// A stretch of the file that is no intact event.
struct LogDamage {
  std::int64_t offset = 0;
  std::int64_t bytes = 0;  ///< 0: a compressed log ends before its time
  std::string reason;
};

/// Whether a file begins like an event log, plain or zstd-compressed.
bool is_event_log(const std::string& path);

/// Reads LCM event logs: bounded memory, resynchronising, never trusts a length it has not checked.
/// A zstd file is unpacked into a temporary file first; offsets and sizes are those of the log in
/// it.
///
/// An event counts as intact when its lengths are in bounds (channel 1..kMaxChannel printable
/// bytes, payload at most kMaxPayload) and a sync word or the end of the file follows. One with
/// other bytes behind it is still given, unless another intact event begins inside it or reaches
/// past its end; the bytes behind it are the damage. A changed payload byte cannot be seen; the
/// format has no checksum.
class LcmLogReader {
 public:
  static constexpr std::int32_t kMaxChannel = 63;
  static constexpr std::int32_t kMaxPayload = 16 * 1024 * 1024;

  LcmLogReader() = default;
  ~LcmLogReader();
  LcmLogReader(const LcmLogReader&) = delete;
  LcmLogReader& operator=(const LcmLogReader&) = delete;

  /// False when the file cannot be opened or is no regular file; error() says why.
  [[nodiscard]] bool open(const std::string& path);
  /// The buffers of `event` are reused. Call until end or error; both are final.
  [[nodiscard]] LogRead next(LogEvent& event);
  const LogDamage& damage() const { return damage_; }
  const std::string& error() const { return error_; }
  std::int64_t size() const { return size_; }          ///< bytes, when it was opened
  std::int64_t position() const { return position_; }  ///< bytes consumed

 private:
  bool unpack();

  struct Header {
    std::int64_t number, timestamp_us;
    std::int64_t channel_length, payload_length;
    std::int64_t end;  ///< offset after the event
  };

  const std::uint8_t* at(std::int64_t offset, std::int64_t bytes);
  bool sync_at(std::int64_t offset);
  bool read_header(std::int64_t offset, Header& header, const char** why);
  bool well_followed(const Header& header);
  std::int64_t find_sync(std::int64_t from, std::int64_t limit);
  std::int64_t first_certain_event(std::int64_t from, std::int64_t limit);
  bool nothing_better_inside(const Header& header);
  std::int64_t resynchronise(std::int64_t from);
  LogRead skip_damage(const Header& header, bool plausible, const char* why);
  bool zeros_to_end(std::int64_t from);

  int file_ = -1;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  std::vector<std::uint8_t> buffer_;
  std::int64_t buffer_offset_ = 0;
  std::int64_t buffer_bytes_ = 0;
  std::int64_t clear_from_ = 0;  ///< no certain event starts in [clear_from_, clear_to_)
  std::int64_t clear_to_ = 0;
  std::int64_t certain_ = -1;  ///< where the last certain event was found
  LogDamage damage_;
  std::string pack_damage_;  ///< of the zstd file; told at the end
  std::string error_;
};

/// Appends one event as it stands in a log to `out`. Channel and size must be within the reader's
/// bounds.
void append_log_event(std::string& out, std::int64_t number, std::int64_t timestamp_us,
                      std::string_view channel, const void* data, std::size_t size);

/// Writes LCM event logs that lcm-logplayer plays. Event numbers count from 0.
/// The file is written as PATH.partial and renamed by close(): nothing half-written under its name.
class LcmLogWriter {
 public:
  LcmLogWriter() = default;
  /// Removes the partial file when close() was not called.
  ~LcmLogWriter();
  LcmLogWriter(const LcmLogWriter&) = delete;
  LcmLogWriter& operator=(const LcmLogWriter&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  /// False, once and for all, when the channel or payload is out of bounds or the disk is full.
  [[nodiscard]] bool write(std::int64_t timestamp_us, const std::string& channel, const void* data,
                           std::size_t size);
  /// The same with the event's own number, as it was logged.
  [[nodiscard]] bool copy(const LogEvent& event);
  /// The next event gets this number, and those after it follow.
  void number_from(std::int64_t number) { number_ = number; }
  /// Flushes to the disk and renames. False when anything was not written; then nothing stays.
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }
  std::int64_t events() const { return number_; }  ///< number of the next one

 private:
  void discard();

  std::vector<char> buffer_;
  std::FILE* file_ = nullptr;
  std::string path_;
  std::int64_t number_ = 0;
  std::string error_;
};

}  // namespace framewatch::drivers
