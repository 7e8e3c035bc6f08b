// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/files/input_file.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/log_scan.h"

namespace framewatch::drivers {

/// One event of an LCM event log.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t timestamp_us = 0;  ///< when it was received, host clock
  std::string channel;
  std::vector<std::uint8_t> data;
  std::int64_t offset = 0;  ///< of its sync word in the file
};

enum class LogRead {
  event,      ///< an intact event was read
  damage,     ///< bytes were skipped to find the next event; see damage()
  truncated,  ///< the file ends inside an event, or in zeros left by a crash; see damage()
  end,        ///< the file ends after an event, or after the damage reported before
  error,      ///< the operating system refused a read; see error()
};

/// A stretch of the file that is not an intact event.
struct LogDamage {
  std::int64_t offset = 0;
  std::int64_t bytes = 0;  ///< 0: a compressed log ends too early
  std::string reason;
};

/// Returns true if a file begins like an event log, plain or zstd-compressed.
bool is_event_log(const std::string& path);

/// Reads LCM event logs in bounded memory. Finds the next event after damage, and trusts no length
/// that it has not checked. Unpacks a zstd file into a temporary file first; offsets and sizes are
/// those of the log in it.
///
/// An event is intact when its lengths are in bounds (channel 1..kMaxChannel printable bytes,
/// payload at most kMaxPayload) and a sync word or the end of the file follows. An event with other
/// bytes behind it is still returned, unless another intact event begins inside it or reaches past
/// its end; the bytes behind it are the damage. A changed payload byte goes unnoticed: the format
/// has no checksum.
class LcmLogReader {
 public:
  static constexpr std::int32_t kMaxChannel = LogScan::kMaxChannel;
  static constexpr std::int32_t kMaxPayload = LogScan::kMaxPayload;

  LcmLogReader() = default;
  LcmLogReader(const LcmLogReader&) = delete;
  LcmLogReader& operator=(const LcmLogReader&) = delete;

  /// Opens a log. Returns false and sets error() when the file cannot be opened, is not a regular
  /// file, or unpacks to more than unpack_limit().
  [[nodiscard]] bool open(const std::string& path);
  /// Reads the next event and reuses the buffers of `event`. Call it until end or error, which are
  /// final.
  [[nodiscard]] LogRead next(LogEvent& event);
  const LogDamage& damage() const { return damage_; }
  const std::string& error() const { return error_; }
  std::int64_t size() const { return file_.size(); }   ///< bytes, when it was opened
  std::int64_t position() const { return position_; }  ///< bytes consumed
  /// Returns the bytes examined so far, with repetitions: a few times position(), whatever the file
  /// holds.
  std::int64_t examined_bytes() const;

 private:
  bool unpack();
  std::int64_t first_certain_event(std::int64_t from, std::int64_t limit);
  bool reached_over(const LogEventHeader& header);
  std::int64_t find_next_event(std::int64_t from);
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
  OverlapScan overlaps_;          ///< what looks like events, from position_ to overlap_to_
  std::int64_t overlap_to_ = -1;  ///< where to search on; -1: not begun

  LogDamage damage_;
  std::string pack_damage_;  ///< of the zstd file, reported at the end
};

/// Calls `take` for every event of a log until it returns false. Returns false and appends the
/// problem when the log cannot be read, is damaged or is cut off: offline commands stop at damage.
bool for_each_event(const std::string& path, const std::function<bool(const LogEvent&)>& take,
                    std::vector<Problem>& problems);

/// Returns the place of an event for messages: "PATH: event 17 (byte 1234)".
std::string place_of(const std::string& path, const LogEvent& event);

/// Appends one event in the format of a log to `out`. Channel and size must be within the bounds of
/// LcmLogReader.
void append_log_event(std::string& out, std::int64_t number, std::int64_t timestamp_us,
                      std::string_view channel, const void* data, std::size_t size);

/// Writes LCM event logs that lcm-logplayer plays. Event numbers count from 0. The file is a
/// PartialFile until close(), so that its name never shows half-written contents.
class LcmLogWriter {
 public:
  LcmLogWriter() = default;
  /// Removes the partial file when close() was not called.
  ~LcmLogWriter();
  LcmLogWriter(const LcmLogWriter&) = delete;
  LcmLogWriter& operator=(const LcmLogWriter&) = delete;

  [[nodiscard]] bool open(const std::string& path);
  /// Writes an event. Returns false when channel or payload are out of bounds or the system
  /// refuses; then every later call fails, too.
  [[nodiscard]] bool write(std::int64_t timestamp_us, const std::string& channel, const void* data,
                           std::size_t size);
  /// Writes an event that was read from a log and keeps its number.
  [[nodiscard]] bool copy(const LogEvent& event);
  /// Sets the number of the next event; later events count on.
  void number_from(std::int64_t number) { number_ = number; }
  /// Flushes to the disk and renames the file. Returns false when anything was not written; the
  /// file is then removed.
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }
  std::int64_t events() const { return number_; }  ///< number of the next event

 private:
  void discard();

  std::vector<char> buffer_;
  PartialFile partial_;
  std::FILE* file_ = nullptr;
  std::int64_t number_ = 0;
  std::string error_;
};

}  // namespace framewatch::drivers
