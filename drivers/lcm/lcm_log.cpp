// SPDX-License-Identifier: MIT
#include "drivers/lcm/lcm_log.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/packed_file.h"

namespace framewatch::drivers {
namespace {

using Magic = std::array<std::uint8_t, 4>;

constexpr std::int64_t kHeaderBytes = LogScan::kHeaderBytes;
constexpr std::int64_t kZerosAtOnce = 1 << 20;

Magic magic_of(InputFile& file) {
  Magic magic{};
  if (file.read(magic.data(), magic.size(), 0) != std::ssize(magic)) return {};
  return magic;
}

constexpr std::size_t kBufferBytes = 1 << 18;

template <typename Integer>
std::uint8_t* put_big_endian(std::uint8_t* out, Integer value) {
  for (int shift = 8 * static_cast<int>(sizeof value) - 8; shift >= 0; shift -= 8)
    *out++ = static_cast<std::uint8_t>(value >> shift);
  return out;
}

std::array<std::uint8_t, kHeaderBytes> header_of(std::int64_t number, std::int64_t timestamp_us,
                                                 std::size_t channel_bytes, std::size_t size) {
  std::array<std::uint8_t, kHeaderBytes> header{};
  std::uint8_t* out = put_big_endian(header.data(), std::uint32_t{0xEDA1DA01});
  out = put_big_endian(out, number);
  out = put_big_endian(out, timestamp_us);
  out = put_big_endian(out, static_cast<std::int32_t>(channel_bytes));
  put_big_endian(out, static_cast<std::int32_t>(size));
  return header;
}

}  // namespace

bool is_event_log(const std::string& path) {
  InputFile file;
  if (!file.open(path)) return false;
  const Magic magic = magic_of(file);
  return magic == kZstdMagic || begins_with_sync(magic.data());
}

bool LcmLogReader::open(const std::string& path) {
  position_ = clear_from_ = clear_to_ = 0;
  certain_ = overlap_to_ = -1;
  damage_ = {};
  pack_damage_.clear();
  for (LogScan* scan : {&here_, &certain_scan_, &overlap_scan_}) scan->clear();
  overlaps_.clear();
  const bool opened = file_.open(path);
  error_ = file_.error();
  return opened && unpack();
}

/// Unpacks a zstd file and continues with the log in it.
bool LcmLogReader::unpack() {
  if (magic_of(file_) != kZstdMagic) return true;
  UnpackedFile unpacked = unpack_zstd(file_.descriptor());
  file_.adopt(unpacked.file, unpacked.bytes);
  pack_damage_ = std::move(unpacked.damage);
  error_ = std::move(unpacked.error);
  return file_.is_open();
}

std::int64_t LcmLogReader::examined_bytes() const {
  return here_.examined_bytes() + certain_scan_.examined_bytes() + overlap_scan_.examined_bytes();
}

/// Returns the start of the first well-followed event in [from, limit), or limit.
std::int64_t LcmLogReader::first_certain_event(std::int64_t from, std::int64_t limit) {
  if (from < clear_from_ || from > clear_to_) clear_from_ = clear_to_ = from;
  while (clear_to_ < limit && clear_to_ != certain_) {
    clear_to_ = certain_scan_.find_sync(clear_to_, limit);
    LogEventHeader header{};
    if (clear_to_ == limit) break;
    if (certain_scan_.read_header(clear_to_, header, nullptr) &&
        certain_scan_.well_followed(header))
      certain_ = clear_to_;
    else
      ++clear_to_;
  }
  return std::min(clear_to_, limit);
}

/// Returns true if something like an event begins inside the event at position_ and reaches past
/// its end. Precondition: that event ends within the file.
bool LcmLogReader::reached_over(const LogEventHeader& event) {
  if (overlap_to_ <= position_) {
    overlaps_.clear();
    overlap_to_ = position_;
  }
  overlaps_.drop_before(position_);
  while (overlap_to_ < event.end && overlaps_.reached_over_at() == OverlapScan::kNone) {
    overlap_to_ = overlap_scan_.find_sync(overlap_to_, event.end);
    if (overlap_to_ == event.end) break;
    LogEventHeader header{};
    if (overlap_scan_.read_header(overlap_to_, header, nullptr) && header.end <= size())
      overlaps_.add(overlap_to_, header.end);
    ++overlap_to_;
  }
  return overlaps_.reached_over_at() < event.end;
}

/// Returns the start of the next event to return at or after `from`; size() when there is no
/// further event.
std::int64_t LcmLogReader::find_next_event(std::int64_t from) {
  const std::int64_t certain = first_certain_event(from, size());
  for (std::int64_t start = here_.find_sync(from, certain); start < certain;
       start = here_.find_sync(start + 1, certain)) {
    LogEventHeader header{};
    if (here_.read_header(start, header, nullptr) && header.end <= certain) return start;
  }
  return certain;
}

bool LcmLogReader::zeros_to_end(std::int64_t from) {
  while (from < size()) {
    const std::int64_t bytes = std::min(kZerosAtOnce, size() - from);
    const std::uint8_t* begin = here_.at(from, bytes);
    if (begin == nullptr || std::any_of(begin, begin + bytes, [](auto byte) { return byte != 0; }))
      return false;
    from += bytes;
  }
  return true;
}

LogRead LcmLogReader::skip_damage(const LogEventHeader& header, bool plausible, const char* why) {
  const std::int64_t start = position_;
  const bool at_sync = here_.sync_at(start);
  const std::int64_t resume = find_next_event(start + 1);
  LogRead result = LogRead::damage;
  if (resume == size() && at_sync && start + kHeaderBytes > size()) {
    result = LogRead::truncated;
  } else if (resume == size() && plausible && header.end > size()) {
    result = LogRead::truncated;
    why = "the file ends inside an event";
  } else if (resume == size() && zeros_to_end(start)) {
    result = LogRead::truncated;
    why = "zeros up to the end of the file";
  } else if (plausible) {
    why = "the event's lengths reach beyond the start of the next one";
  }
  if (!error_.empty()) return LogRead::error;
  damage_ = {start, resume - start, why};
  position_ = resume;
  return result;
}

LogRead LcmLogReader::next(LogEvent& event) {
  if (!error_.empty()) return LogRead::error;
  if (position_ >= size()) {
    if (pack_damage_.empty()) return LogRead::end;
    damage_ = {size(), 0, std::move(pack_damage_)};
    pack_damage_.clear();
    return LogRead::truncated;
  }
  LogEventHeader header{};
  const char* why = "";
  const bool plausible = here_.read_header(position_, header, &why);
  const bool acceptable =
      plausible && header.end <= size() &&
      (here_.well_followed(header) ||
       (first_certain_event(position_ + 1, header.end) == header.end && !reached_over(header)));
  if (!acceptable) return error_.empty() ? skip_damage(header, plausible, why) : LogRead::error;

  const std::uint8_t* bytes = here_.at(position_, header.end - position_);
  if (bytes == nullptr) return LogRead::error;
  event.offset = position_;
  event.number = header.number;
  event.timestamp_us = header.timestamp_us;
  const std::uint8_t* channel = bytes + kHeaderBytes;
  const std::uint8_t* payload = channel + header.channel_length;
  event.channel.assign(channel, payload);
  event.data.assign(payload, payload + header.payload_length);
  position_ = header.end;
  return LogRead::event;
}

bool for_each_event(const std::string& path, const std::function<bool(const LogEvent&)>& take,
                    std::vector<Problem>& problems) {
  LcmLogReader log;
  if (!log.open(path)) {
    problems.push_back({path, log.error()});
    return false;
  }
  for (LogEvent event;;) {
    switch (log.next(event)) {
      case LogRead::event:
        if (!take(event)) return true;
        break;
      case LogRead::end:
        return true;
      case LogRead::error:
        problems.push_back({path, log.error()});
        return false;
      case LogRead::damage:
      case LogRead::truncated:
        problems.push_back({fmt::format("{}: byte {}", path, log.damage().offset),
                            fmt::format("{} bytes are not an LCM event: {}", log.damage().bytes,
                                        log.damage().reason)});
        return false;
    }
  }
}

std::string place_of(const std::string& path, const LogEvent& event) {
  return fmt::format("{}: event {} (byte {})", path, event.number, event.offset);
}

void append_log_event(std::string& out, std::int64_t number, std::int64_t timestamp_us,
                      std::string_view channel, const void* data, std::size_t size) {
  const auto header = header_of(number, timestamp_us, channel.size(), size);
  out.append(header.begin(), header.end());
  out += channel;
  out.append(static_cast<const char*>(data), size);
}

LcmLogWriter::~LcmLogWriter() {
  discard();
}

bool LcmLogWriter::open(const std::string& path) {
  discard();
  number_ = 0;
  error_.clear();
  if (partial_.open(path)) file_ = partial_.stream();
  if (file_ == nullptr) {
    error_ = partial_.error();
    partial_.discard();
    return false;
  }
  // glibc ignores the size when it allocates the buffer itself.
  buffer_.resize(kBufferBytes);
  std::setvbuf(file_, buffer_.data(), _IOFBF, buffer_.size());
  return true;
}

bool LcmLogWriter::copy(const LogEvent& event) {
  number_ = event.number;
  return write(event.timestamp_us, event.channel, event.data.data(), event.data.size());
}

bool LcmLogWriter::write(std::int64_t timestamp_us, const std::string& channel, const void* data,
                         std::size_t size) {
  if (file_ == nullptr || !error_.empty()) return false;
  if (channel.empty() || channel.size() > LcmLogReader::kMaxChannel) {
    error_ = "channel name must have 1 to 63 bytes";
    return false;
  }
  if (size > LcmLogReader::kMaxPayload) {
    error_ = "payload is larger than 16 MiB";
    return false;
  }
  const auto header = header_of(number_, timestamp_us, channel.size(), size);
  if (std::fwrite(header.data(), 1, header.size(), file_) != header.size() ||
      std::fwrite(channel.data(), 1, channel.size(), file_) != channel.size() ||
      (size > 0 && std::fwrite(data, 1, size, file_) != size)) {
    error_ = std::strerror(errno);
    return false;
  }
  ++number_;
  return true;
}

bool LcmLogWriter::close() {
  if (file_ == nullptr) return false;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (error_.empty() && !closed) error_ = std::strerror(errno);
  if (error_.empty() && !partial_.commit()) error_ = partial_.error();
  discard();
  return error_.empty();
}

void LcmLogWriter::discard() {
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  partial_.discard();
}

}  // namespace framewatch::drivers
