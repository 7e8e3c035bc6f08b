#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "drivers/base/zstd_file.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<std::uint8_t, 4> kSync{0xED, 0xA1, 0xDA, 0x01};
constexpr std::int64_t kSyncBytes = 4;
constexpr std::int64_t kHeaderBytes = 28;
constexpr std::int64_t kBufferBytes = 1 << 20;

std::int64_t big_endian_64(const std::uint8_t* bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | bytes[i];
  return static_cast<std::int64_t>(value);
}

std::int32_t big_endian_32(const std::uint8_t* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | bytes[i];
  return static_cast<std::int32_t>(value);
}

bool printable(std::uint8_t byte) {
  return byte >= 0x20 && byte != 0x7f;
}

}  // namespace

bool is_event_log(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, kSyncBytes> head{};
  in.read(head.data(), head.size());
  return in && (std::memcmp(head.data(), kSync.data(), kSync.size()) == 0 ||
                std::memcmp(head.data(), kZstdMagic.data(), kZstdMagic.size()) == 0);
}

LcmLogReader::~LcmLogReader() {
  if (file_ >= 0) ::close(file_);
}

bool LcmLogReader::open(const std::string& path) {
  if (file_ >= 0) ::close(file_);
  position_ = size_ = buffer_offset_ = buffer_bytes_ = clear_from_ = clear_to_ = 0;
  certain_ = -1;
  damage_ = {};
  pack_damage_.clear();
  error_.clear();
  file_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (file_ < 0 || ::fstat(file_, &status) != 0) {
    error_ = std::strerror(errno);
    return false;
  }
  if (!S_ISREG(status.st_mode)) {
    error_ = S_ISDIR(status.st_mode) ? "is a directory" : "is not a regular file";
    return false;
  }
  size_ = status.st_size;
  return unpack();
}

/// Goes on with the log inside when the file is a zstd one.
bool LcmLogReader::unpack() {
  std::array<std::uint8_t, kZstdMagic.size()> head{};
  if (::pread(file_, head.data(), head.size(), 0) != std::ssize(head) ||
      std::memcmp(head.data(), kZstdMagic.data(), head.size()) != 0)
    return true;
  UnpackedFile unpacked = unpack_zstd(file_);
  ::close(file_);
  file_ = unpacked.file;
  size_ = unpacked.bytes;
  pack_damage_ = std::move(unpacked.damage);
  error_ = std::move(unpacked.error);
  return file_ >= 0;
}

/// Pointer to `bytes` bytes at `offset`, or null (error_ set) when they cannot be read.
/// Precondition: offset + bytes <= size_.
const std::uint8_t* LcmLogReader::at(std::int64_t offset, std::int64_t bytes) {
  if (offset >= buffer_offset_ && offset + bytes <= buffer_offset_ + buffer_bytes_)
    return buffer_.data() + (offset - buffer_offset_);
  const std::int64_t wanted = std::min(std::max(bytes, kBufferBytes), size_ - offset);
  if (std::ssize(buffer_) < wanted) buffer_.resize(static_cast<std::size_t>(wanted));
  buffer_offset_ = offset;
  buffer_bytes_ = 0;
  while (buffer_bytes_ < wanted) {
    const ssize_t got =
        ::pread(file_, buffer_.data() + buffer_bytes_,
                static_cast<std::size_t>(wanted - buffer_bytes_), offset + buffer_bytes_);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      error_ = got < 0 ? std::strerror(errno) : "became shorter while it was read";
      return nullptr;
    }
    buffer_bytes_ += got;
  }
  return buffer_.data();
}

/// Whether a sync word, or as much of one as fits into the file, is at `offset`.
bool LcmLogReader::sync_at(std::int64_t offset) {
  const std::int64_t bytes = std::min(kSyncBytes, size_ - offset);
  if (offset >= buffer_offset_ && offset + bytes <= buffer_offset_ + buffer_bytes_) {
    const std::uint8_t* word = at(offset, bytes);
    return bytes == kSyncBytes
               ? std::memcmp(word, kSync.data(), kSyncBytes) == 0
               : std::memcmp(word, kSync.data(), static_cast<std::size_t>(bytes)) == 0;
  }
  std::array<std::uint8_t, kSyncBytes> word{};
  if (::pread(file_, word.data(), static_cast<std::size_t>(bytes), offset) != bytes) return false;
  return std::memcmp(word.data(), kSync.data(), static_cast<std::size_t>(bytes)) == 0;
}

/// Whether a header with acceptable lengths and channel is at `offset`; `why` not, when not null.
bool LcmLogReader::read_header(std::int64_t offset, Header& header, const char** why) {
  const auto refuse = [why](const char* reason) {
    if (why != nullptr) *why = reason;
    return false;
  };
  if (!sync_at(offset)) return refuse("no sync word where an event should start");
  if (offset + kHeaderBytes > size_) return refuse("the file ends inside an event's header");
  const std::uint8_t* bytes = at(offset, kHeaderBytes);
  if (bytes == nullptr) return refuse("unreadable");
  header.number = big_endian_64(bytes + 4);
  header.timestamp_us = big_endian_64(bytes + 12);
  header.channel_length = big_endian_32(bytes + 20);
  header.payload_length = big_endian_32(bytes + 24);
  if (header.channel_length < 1 || header.channel_length > kMaxChannel)
    return refuse("channel length out of bounds (1 to 63)");
  if (header.payload_length < 0 || header.payload_length > kMaxPayload)
    return refuse("payload length out of bounds (0 to 16 MiB)");
  header.end = offset + kHeaderBytes + header.channel_length + header.payload_length;
  const std::int64_t channel_bytes = std::min(header.channel_length, size_ - offset - kHeaderBytes);
  const std::uint8_t* channel = at(offset + kHeaderBytes, channel_bytes);
  if (channel == nullptr) return refuse("unreadable");
  if (!std::all_of(channel, channel + channel_bytes, printable))
    return refuse("channel name with unprintable characters");
  return true;
}

bool LcmLogReader::well_followed(const Header& header) {
  return header.end == size_ || (header.end < size_ && sync_at(header.end));
}

/// Offset of the first sync word in [from, limit), or limit.
std::int64_t LcmLogReader::find_sync(std::int64_t from, std::int64_t limit) {
  while (from < limit && size_ - from >= kSyncBytes) {
    const std::int64_t bytes = std::min(kBufferBytes / 4, size_ - from);
    const std::uint8_t* begin = at(from, bytes);
    if (begin == nullptr) return limit;
    const std::uint8_t* found = std::search(begin, begin + bytes, kSync.begin(), kSync.end());
    if (found != begin + bytes) return std::min(limit, from + (found - begin));
    from += bytes - (kSyncBytes - 1);
  }
  return limit;
}

/// First well-followed event that starts in [from, limit), or limit.
std::int64_t LcmLogReader::first_certain_event(std::int64_t from, std::int64_t limit) {
  if (from < clear_from_ || from > clear_to_) clear_from_ = clear_to_ = from;
  while (clear_to_ < limit && clear_to_ != certain_) {
    clear_to_ = find_sync(clear_to_, limit);
    Header header{};
    if (clear_to_ == limit) break;
    if (read_header(clear_to_, header, nullptr) && well_followed(header))
      certain_ = clear_to_;
    else
      ++clear_to_;
  }
  return std::min(clear_to_, limit);
}

/// Whether no certain event starts inside the event at position_, and none reaches over its end.
bool LcmLogReader::nothing_better_inside(const Header& header) {
  if (first_certain_event(position_ + 1, header.end) < header.end) return false;
  for (std::int64_t start = find_sync(position_ + 1, header.end); start < header.end;
       start = find_sync(start + 1, header.end)) {
    Header inner{};
    if (read_header(start, inner, nullptr) && inner.end > header.end && inner.end <= size_)
      return false;
  }
  return true;
}

/// Where the next event to be given starts at or after `from`; size_ when there is none.
std::int64_t LcmLogReader::resynchronise(std::int64_t from) {
  const std::int64_t certain = first_certain_event(from, size_);
  for (std::int64_t start = find_sync(from, certain); start < certain;
       start = find_sync(start + 1, certain)) {
    Header header{};
    if (read_header(start, header, nullptr) && header.end <= certain) return start;
  }
  return certain;
}

bool LcmLogReader::zeros_to_end(std::int64_t from) {
  while (from < size_) {
    const std::int64_t bytes = std::min(kBufferBytes, size_ - from);
    const std::uint8_t* begin = at(from, bytes);
    if (begin == nullptr || std::any_of(begin, begin + bytes, [](auto byte) { return byte != 0; }))
      return false;
    from += bytes;
  }
  return true;
}

LogRead LcmLogReader::skip_damage(const Header& header, bool plausible, const char* why) {
  const std::int64_t start = position_;
  const bool at_sync = sync_at(start);
  const std::int64_t resume = resynchronise(start + 1);
  LogRead result = LogRead::damage;
  if (resume == size_ && at_sync && start + kHeaderBytes > size_) {
    result = LogRead::truncated;
  } else if (resume == size_ && plausible && header.end > size_) {
    result = LogRead::truncated;
    why = "the file ends inside an event";
  } else if (resume == size_ && zeros_to_end(start)) {
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
  if (position_ >= size_) {
    if (pack_damage_.empty()) return LogRead::end;
    damage_ = {size_, 0, std::move(pack_damage_)};
    pack_damage_.clear();
    return LogRead::truncated;
  }
  Header header{};
  const char* why = "";
  const bool plausible = read_header(position_, header, &why);
  const bool acceptable =
      plausible && header.end <= size_ && (well_followed(header) || nothing_better_inside(header));
  if (!acceptable) return error_.empty() ? skip_damage(header, plausible, why) : LogRead::error;

  const std::uint8_t* bytes = at(position_, header.end - position_);
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
