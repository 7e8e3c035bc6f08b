#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/log_scan.h"
#include "drivers/lcm/overlap_scan.h"

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
  static constexpr std::int32_t kMaxChannel = LogScan::kMaxChannel;
  static constexpr std::int32_t kMaxPayload = LogScan::kMaxPayload;

  LcmLogReader() = default;
  LcmLogReader(const LcmLogReader&) = delete;
  LcmLogReader& operator=(const LcmLogReader&) = delete;

  /// False when the file cannot be opened, is no regular file, or unpacks to more than
  /// unpack_limit(); error() says why.
  [[nodiscard]] bool open(const std::string& path);
  /// The buffers of `event` are reused. Call until end or error; both are final.
  [[nodiscard]] LogRead next(LogEvent& event);
  const LogDamage& damage() const { return damage_; }
  const std::string& error() const { return error_; }
  std::int64_t size() const { return file_.size(); }   ///< bytes, when it was opened
  std::int64_t position() const { return position_; }  ///< bytes consumed
  /// Bytes looked at so far, as often as they were: a few times position(), whatever the file
  /// holds.
  std::int64_t examined_bytes() const;

 private:
  bool unpack();
  std::int64_t first_certain_event(std::int64_t from, std::int64_t limit);
  bool reached_over(const LogEventHeader& header);
  std::int64_t resynchronise(std::int64_t from);
  LogRead skip_damage(const LogEventHeader& header, bool plausible, const char* why);
  bool zeros_to_end(std::int64_t from);

  InputFile file_;
  std::string error_;
  LogScan here_{file_, error_};
  std::int64_t position_ = 0;

  LogScan certain_scan_{file_, error_};
  std::int64_t clear_from_ = 0;  ///< no certain event starts in [clear_from_, clear_to_)
  std::int64_t clear_to_ = 0;
  std::int64_t certain_ = -1;  ///< where the last certain event was found

  LogScan overlap_scan_{file_, error_};
  OverlapScan overlaps_;          ///< of what looks like events, from position_ to overlap_to_
  std::int64_t overlap_to_ = -1;  ///< where to look for the next; -1: nowhere yet

  LogDamage damage_;
  std::string pack_damage_;  ///< of the zstd file; told at the end
};

/// Appends one event as it stands in a log to `out`. Channel and size must be within the reader's
/// bounds.
void append_log_event(std::string& out, std::int64_t number, std::int64_t timestamp_us,
                      std::string_view channel, const void* data, std::size_t size);

/// Writes LCM event logs that lcm-logplayer plays. Event numbers count from 0.
/// The file is a PartialFile that close() renames: nothing half-written under its name.
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
  PartialFile partial_;
  std::FILE* file_ = nullptr;
  std::int64_t number_ = 0;
  std::string error_;
};

}  // namespace framewatch::drivers
