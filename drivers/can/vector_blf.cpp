// SPDX-License-Identifier: MIT
// Vector publishes the layout only with its library. This reader follows the descriptions of
// Tobias Lorenz's Vector_BLF, python-can and Wireshark: a header, then objects that begin with
// LOBJ; containers hold compressed pieces of a stream of further objects. All numbers are
// little-endian.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "drivers/can/vector_log.h"
#include "drivers/files/packed_file.h"

namespace framewatch::drivers {
namespace {

using BlfBytes = std::span<const std::uint8_t>;

constexpr std::string_view kFileMark = "LOGG", kObjectMark = "LOBJ";
constexpr std::size_t kFileHeaderBytes = 72;  ///< at least
constexpr std::size_t kBaseBytes = 16;        ///< mark, sizes, type
constexpr std::size_t kHeaderBytes = 32;      ///< the base, then the stamp; also of a container
constexpr std::size_t kMostPadding = 7;       ///< zeros between two objects
constexpr std::uint32_t kMostObjectBytes = 1 << 24;

enum BlfType : std::uint32_t {
  kMessage = 1,
  kError = 2,
  kContainer = 10,
  kErrorExtended = 73,
  kMessage2 = 86,
  kFdMessage = 100,
  kFdMessage64 = 101,
  kFdError64 = 104,
};

bool is_read(std::uint32_t type) {
  constexpr std::array kTypes = {kMessage,  kError,     kContainer,   kErrorExtended,
                                 kMessage2, kFdMessage, kFdMessage64, kFdError64};
  return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

template <typename Number>
Number little_endian(BlfBytes bytes, std::size_t at) {
  Number value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    value = static_cast<Number>(value | static_cast<Number>(bytes[at + i]) << (8 * i));
  return value;
}

/// Cuts a stream of bytes into objects. Holds the bytes of one object at most.
class BlfObjects {
 public:
  using Take = std::function<void(std::uint32_t type, BlfBytes object, std::uint64_t offset)>;
  using Report = std::function<void(std::uint64_t offset, const std::string& damage)>;

  BlfObjects(Take take, Report report) : take_(std::move(take)), report_(std::move(report)) {}

  /// Counts offsets from here on.
  void begin_at(std::uint64_t offset) { begin_ = offset; }

  /// Takes every object of a type that is read as soon as it is complete.
  void add(BlfBytes bytes) {
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    std::size_t at = 0;
    while (next(at)) {
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at));
    begin_ += at;
  }

  /// Forgets an incomplete object, because bytes of the stream are lost. Continues at the next
  /// object.
  void lose() {
    begin_ += held_.size();
    held_.clear();
    skip_ = gap_ = 0;
    lost_ = true;
  }

  /// Returns true if the stream does not end with an object and its padding.
  bool is_cut() const {
    return skip_ > 0 || held_.size() >= kObjectMark.size() || (gap_ > kMostPadding && !lost_);
  }

 private:
  /// Advances `at` by an object. Returns false when the bytes held do not suffice.
  bool next(std::size_t& at) {
    const auto skipped = std::min<std::uint64_t>(skip_, held_.size() - at);
    at += skipped;
    skip_ -= skipped;
    if (skip_ > 0) return false;
    const auto mark = std::search(held_.begin() + static_cast<std::ptrdiff_t>(at), held_.end(),
                                  kObjectMark.begin(), kObjectMark.end());
    const bool found = mark != held_.end();
    const std::size_t mark_at =
        found ? static_cast<std::size_t>(mark - held_.begin())
              : std::max(at, held_.size() - std::min(held_.size(), kObjectMark.size() - 1));
    gap_ += mark_at - at;
    at = mark_at;
    if (!found) return false;
    if (gap_ > kMostPadding && !lost_)
      report_(begin_ + at - gap_, fmt::format("{} bytes belong to no object", gap_));
    gap_ = 0;
    lost_ = false;
    if (held_.size() - at < kBaseBytes) return false;
    const BlfBytes object(held_.data() + at, held_.size() - at);
    const auto bytes = little_endian<std::uint32_t>(object, 8);
    const auto type = little_endian<std::uint32_t>(object, 12);
    if (bytes < kBaseBytes || (is_read(type) && bytes > kMostObjectBytes)) {
      report_(begin_ + at, fmt::format("an object of type {} has {} bytes, not {} to {}", type,
                                       bytes, kBaseBytes, kMostObjectBytes));
      at += kObjectMark.size();
      lost_ = true;
      return true;
    }
    if (!is_read(type)) {
      skip_ = bytes;
      return true;
    }
    if (object.size() < bytes) return false;
    take_(type, object.first(bytes), begin_ + at);
    at += bytes;
    return true;
  }

  Take take_;
  Report report_;
  std::vector<std::uint8_t> held_;
  std::uint64_t begin_ = 0;  ///< offset of the first byte held
  std::uint64_t skip_ = 0;   ///< bytes of an object that is not read
  std::uint64_t gap_ = 0;    ///< bytes since the last object
  bool lost_ = false;        ///< damage has been reported
};

/// Reads a log from its first to its last byte.
class BlfReader {
 public:
  BlfReader(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
            std::vector<std::string>& notes, std::vector<Problem>& problems)
      : problems_(path, problems),
        zone_min_(zone_min),
        take_(take),
        notes_(notes),
        file_([this](std::uint32_t type, BlfBytes object,
                     std::uint64_t offset) { read(type, object, "byte", offset); },
              [this](std::uint64_t offset, const std::string& damage) {
                report("byte", offset, damage);
              }),
        unpacked_(
            [this](std::uint32_t type, BlfBytes object, std::uint64_t offset) {
              if (type != kContainer) read(type, object, "unpacked byte", offset);
            },
            [this](std::uint64_t offset, const std::string& damage) {
              report("unpacked byte", offset, damage);
            }) {}

  bool run() {
    GzipInput input;
    std::vector<std::uint8_t> buffer(1 << 16);
    if (!input.open(problems_.path()) || !read_header(input)) {
      problems_.add(0, input.error().empty() ? "the header is cut off" : input.error());
      return false;
    }
    std::int64_t got = 0;
    while ((got = input.read(buffer.data(), std::ssize(buffer))) > 0)
      file_.add(BlfBytes(buffer).first(static_cast<std::size_t>(got)));
    if (got < 0) problems_.add(0, input.error());
    if (file_.is_cut() || unpacked_.is_cut())
      problems_.add(0, "is cut off: the last object is not complete");
    return !problems_.any();
  }

 private:
  void report(const char* unit, std::uint64_t offset, const std::string& damage) {
    problems_.add(0, fmt::format("{} {}: {}", unit, offset, damage));
  }

  bool read_header(GzipInput& input) {
    std::vector<std::uint8_t> header(kFileHeaderBytes);
    if (input.read(header.data(), std::ssize(header)) < std::ssize(header)) return false;
    const auto bytes =
        std::max<std::size_t>(little_endian<std::uint32_t>(header, 4), kFileHeaderBytes);
    std::vector<std::uint8_t> rest(std::min<std::size_t>(bytes, 1 << 16) - kFileHeaderBytes);
    if (input.read(rest.data(), std::ssize(rest)) < std::ssize(rest)) return false;
    file_.begin_at(header.size() + rest.size());
    std::array<int, 8> part{};  // year, month, day of the week, day, hour and so on
    for (std::size_t i = 0; i < part.size(); ++i)
      part[i] = little_endian<std::uint16_t>(header, 40 + 2 * i);
    start_us_ = start_of_log(LogDate{part[0], part[1], part[3], part[4], part[5], part[6], part[7]},
                             zone_min_, notes_);
    return true;
  }

  void read(std::uint32_t type, BlfBytes object, const char* unit, std::uint64_t offset) {
    const char* rule = object.size() < kHeaderBytes ? "is shorter than its header"
                       : type == kContainer         ? unpack(object)
                                                    : frame(type, object);
    if (rule != nullptr) report(unit, offset, fmt::format("an object of type {} {}", type, rule));
  }

  const char* unpack(BlfBytes container) {
    const auto method = little_endian<std::uint16_t>(container, 16);
    const auto bytes = little_endian<std::uint32_t>(container, 24);
    const BlfBytes packed = container.subspan(kHeaderBytes);
    if (method == 0) {
      unpacked_.add(packed);
      return nullptr;
    }
    const auto fail = [this](const char* rule) {
      unpacked_.lose();
      return rule;
    };
    if (method != 2) return fail("is packed by an unknown method");
    if (bytes > kMostObjectBytes) return fail("unpacks to more than 16 MiB");
    std::vector<std::uint8_t> plain(bytes);
    uLongf got = bytes;
    if (::uncompress(plain.data(), &got, packed.data(), static_cast<uLong>(packed.size())) != Z_OK)
      return fail("is damaged: it does not unpack");
    unpacked_.add(BlfBytes(plain).first(got));
    return nullptr;
  }

  /// Returns the rule that an object of a frame breaks, or null.
  const char* frame(std::uint32_t type, BlfBytes object) {
    constexpr std::uint64_t kMost_us = 2'000'000'000'000'000;  // 60 years
    const auto header_bytes = little_endian<std::uint16_t>(object, 4);
    const auto stamp = little_endian<std::uint64_t>(object, 24);
    const bool is_coarse =
        little_endian<std::uint32_t>(object, 16) == 1;  // units of 10 us, or 1 ns
    if (header_bytes < kHeaderBytes || header_bytes > object.size())
      return "has a header that does not fit";
    if (stamp > (is_coarse ? kMost_us / 10 : kMost_us * 1000)) return "is 60 years after the start";
    const std::uint64_t after_us = is_coarse ? stamp * 10 : (stamp + 500) / 1000;
    CanFrame frame;
    frame.stamp_us = start_us_ + static_cast<std::int64_t>(after_us);
    const BlfBytes body = object.subspan(header_bytes);
    switch (type) {
      case kFdMessage64:
        return long_message(body, frame);
      case kFdError64:
        return error(body, 1, frame);
      case kError:
      case kErrorExtended:
        return error(body, 2, frame);
      default:
        return message(type, body, frame);
    }
  }

  const char* error(BlfBytes body, std::size_t channel_bytes, const CanFrame& at) {
    if (body.size() < channel_bytes) return "has no channel";
    const unsigned channel = channel_bytes == 1 ? body[0] : little_endian<std::uint16_t>(body, 0);
    take_(plain_error_frame(at.stamp_us), interface_of_channel(channel));
    return nullptr;
  }

  /// Reads CAN_MESSAGE, CAN_MESSAGE2 and CAN_FD_MESSAGE: channel (2 bytes), flags, data length
  /// code, id (4 bytes), data; in CAN_FD_MESSAGE 12 bytes before the data, the sixth with flags.
  const char* message(std::uint32_t type, BlfBytes body, CanFrame frame) {
    const std::size_t data_at = type == kFdMessage ? 20 : 8;
    if (body.size() < data_at) return "has no data";
    const unsigned flags = body[2];
    const unsigned fd_flags = type == kFdMessage ? body[13] : 0;
    frame.fd = (fd_flags & 1) != 0;
    frame.bit_rate_switch = (fd_flags & 2) != 0;
    frame.remote = (flags & 0x80) != 0;
    return deliver(little_endian<std::uint16_t>(body, 0), flags & 0xF, body[3],
                   little_endian<std::uint32_t>(body, 4), body.subspan(data_at), frame);
  }

  /// Reads CAN_FD_MESSAGE_64: channel, data length code, bytes of data, a count, id (4 bytes),
  /// duration (4), flags (4), 16 bytes of bit timing, bits (2), direction, an offset, CRC (4),
  /// data.
  const char* long_message(BlfBytes body, CanFrame frame) {
    constexpr std::size_t kDataAt = 40;
    if (body.size() < kDataAt) return "has no data";
    const auto flags = little_endian<std::uint32_t>(body, 12);
    frame.remote = (flags & 0x10) != 0;
    frame.fd = (flags & 0x1000) != 0;
    frame.bit_rate_switch = (flags & 0x2000) != 0;
    const BlfBytes data = body.subspan(kDataAt);
    return deliver(body[0], body[34], body[1], little_endian<std::uint32_t>(body, 4),
                   data.first(std::min<std::size_t>(data.size(), body[2])), frame);
  }

  const char* deliver(unsigned channel, unsigned direction, unsigned code, std::uint32_t id,
                      BlfBytes data, CanFrame frame) {
    constexpr unsigned kRequestToSend = 2;  // the frame itself follows, sent
    if (direction == kRequestToSend) return nullptr;
    frame.extended = (id & 0x80000000u) != 0;
    frame.id = id & 0x7FFFFFFFu;
    if (frame.id > (frame.extended ? 0x1FFFFFFFu : 0x7FFu)) return "has an id that no frame has";
    if (code > 15) return "has a data length code above 15";
    frame.length = static_cast<std::uint8_t>(bytes_of_code(code, frame.fd));
    if (!frame.remote) {
      if (data.size() < frame.length) return "has fewer bytes than its data length code says";
      std::copy_n(data.begin(), frame.length, frame.data.begin());
    }
    take_(frame, interface_of_channel(channel));
    return nullptr;
  }

  FileProblems problems_;
  std::optional<int> zone_min_;
  const TakeCanFrame& take_;
  std::vector<std::string>& notes_;
  BlfObjects file_, unpacked_;
  std::int64_t start_us_ = 0;
};

}  // namespace

bool looks_like_blf(const std::string& path) {
  GzipInput input;
  std::string head(kFileMark.size(), '\0');
  return input.open(path) && input.read(head.data(), std::ssize(head)) == std::ssize(head) &&
         head == kFileMark;
}

bool read_blf(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
              std::vector<std::string>& notes, std::vector<Problem>& problems) {
  return BlfReader(path, zone_min, take, notes, problems).run();
}

}  // namespace framewatch::drivers
