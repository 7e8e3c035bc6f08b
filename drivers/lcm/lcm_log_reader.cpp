#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "drivers/files/packed_file.h"
#include "drivers/lcm/lcm_log.h"

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

/// Goes on with the log inside when the file is a zstd one.
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

/// First well-followed event that starts in [from, limit), or limit.
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

/// Whether something like an event begins inside the event at position_ and reaches past its end.
/// Precondition: that one ends within the file.
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

/// Where the next event to be given starts at or after `from`; size() when there is none.
std::int64_t LcmLogReader::resynchronise(std::int64_t from) {
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
  const std::int64_t resume = resynchronise(start + 1);
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
    why = "event's lengths reach over the start of the next one";
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

}  // namespace framewatch::drivers
