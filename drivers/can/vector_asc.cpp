// SPDX-License-Identifier: MIT
// The format is described in Vector's "CAN, Log & Trigger ASC Logging Format", version 1.4.6.
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include "drivers/can/vector_log.h"
#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

using Fields = std::vector<std::string_view>;

constexpr std::int64_t kHeaderLines = 10;
constexpr std::int64_t kLongest_us = 2'000'000'000'000'000;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Parses all of `text` as a number without sign. Returns nullopt for any other text, and beyond
/// `most`.
std::optional<std::uint32_t> unsigned_number(std::string_view text, int base, std::uint32_t most) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size() || value > most) return std::nullopt;
  return value;
}

/// Parses "12.002367" to microseconds, without further decimals. Returns nullopt for any other
/// text.
std::optional<std::int64_t> microseconds_of(std::string_view text) {
  constexpr std::uint32_t kMostSeconds = 2'000'000'000;
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const std::size_t dot = std::min(text.find('.'), text.size());
  const auto seconds = unsigned_number(text.substr(0, dot), 10, kMostSeconds);
  std::string decimals(text.substr(std::min(dot + 1, text.size())));
  if (decimals.size() > 9) return std::nullopt;
  decimals.resize(9, '0');
  const auto nanoseconds = unsigned_number(decimals, 10, 999'999'999);
  if (!seconds || !nanoseconds) return std::nullopt;
  const std::int64_t value = 1'000'000 * std::int64_t{*seconds} + *nanoseconds / 1'000;
  return negative ? -value : value;
}

/// Returns the number of a month by its first letters in English or German; 0 for another text.
int month_of(std::string_view text) {
  constexpr std::array<std::string_view, 12> kNames = {"jan", "feb", "mar", "apr", "may", "jun",
                                                       "jul", "aug", "sep", "oct", "nov", "dec"};
  std::string name = lower(text.substr(0, 3));
  if (name.starts_with('m') && name != "may" && name != "mai") name = "mar";  // Mar, Mrz, M\xE4r
  if (name == "mai") name = "may";
  if (name == "okt") name = "oct";
  if (name == "dez") name = "dec";
  const auto at = std::find(kNames.begin(), kNames.end(), name);
  return at == kNames.end() ? 0 : 1 + static_cast<int>(at - kNames.begin());
}

/// Reads "date Sat Sep 30 03:06:13.191 pm 2017"; the parts behind the seconds may be missing.
std::optional<LogDate> date_of(const Fields& fields) {
  if (fields.size() < 6) return std::nullopt;
  const std::string half = fields.size() > 6 ? lower(fields[5]) : "";
  const bool has_half = half == "am" || half == "pm";
  const std::string_view clock = fields[4];
  const auto part = [](std::string_view text, std::uint32_t most) {
    return static_cast<int>(unsigned_number(text, 10, most).value_or(most + 1));
  };
  if (clock.size() < 8 || clock[2] != ':' || clock[5] != ':') return std::nullopt;
  LogDate date;
  date.year = part(fields[has_half ? 6 : 5], 9999);
  date.month = month_of(fields[2]);
  date.day = part(fields[3], 31);
  date.hour = part(clock.substr(0, 2), 23);
  if (has_half && date.hour <= 12) date.hour = date.hour % 12 + (half == "pm" ? 12 : 0);
  date.minute = part(clock.substr(3, 2), 59);
  date.second = part(clock.substr(6, 2), 60);
  if (clock.size() > 9 && clock[8] == '.') {
    std::string decimals(clock.substr(9));
    decimals.resize(3, '0');
    date.millisecond = part(decimals, 999);
  }
  return date;
}

/// Reads a log line by line.
class AscReader {
 public:
  AscReader(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
            std::vector<std::string>& notes, std::vector<Problem>& problems)
      : problems_(path, problems), zone_min_(zone_min), take_(take), notes_(notes) {}

  bool run() {
    LineReader lines(problems_);
    std::string_view line;
    Fields fields;
    while (lines.next(line)) {
      split_blanks(line, fields);
      rule_ = nullptr;
      if (!fields.empty()) read(fields);
      if (rule_ == nullptr && frame_ && !lines.line_ended() && base_ == 10)
        rule_ = "is the last one and may be cut off within a number";
      if (rule_ != nullptr)
        problems_.add(lines.number(), std::string("the line ") + rule_ + ": " + show_text(line));
      else if (frame_)
        take_(*frame_, interface_of_channel(channel_));
      frame_.reset();
    }
    return !problems_.any();
  }

 private:
  void read(const Fields& fields) {
    const auto time_us = microseconds_of(fields[0]);
    if (!time_us) return header(fields);
    if (!started_) {
      start_us_ = start_of_log(date_, zone_min_, notes_);
      started_ = true;
    }
    now_us_ = relative_ ? now_us_ + *time_us : *time_us;
    if (std::abs(now_us_) > kLongest_us) {
      now_us_ = 0;
      return fail("is more than 60 years after the start");
    }
    if (fields.size() < 4) return;
    if (fields[1] == "CANFD")
      flexible(fields);
    else
      classical(fields);
  }

  void header(const Fields& fields) {
    const std::string word = lower(fields[0]);
    if (word == "date") date_ = date_of(fields);
    if (word != "base") return;
    base_ = fields.size() > 1 && lower(fields[1]) == "dec" ? 10 : 16;
    relative_ = std::any_of(fields.begin(), fields.end(),
                            [](std::string_view field) { return lower(field) == "relative"; });
  }

  void fail(const char* rule) { rule_ = rule; }

  static bool is_direction(std::string_view text) {
    return lower(text) == "rx" || lower(text) == "tx";
  }

  bool read_channel(std::string_view text) {
    const auto channel = unsigned_number(text, 10, 255);
    channel_ = channel.value_or(0);
    return channel.has_value();
  }

  bool read_id(std::string_view text, CanFrame& frame) {
    frame.extended = text.ends_with('x') || text.ends_with('X');
    if (frame.extended) text.remove_suffix(1);
    const auto id = unsigned_number(text, base_, frame.extended ? 0x1FFFFFFFu : 0x7FFu);
    frame.id = id.value_or(0);
    return id.has_value();
  }

  /// Reads the bytes from fields[at] on. In hexadecimal, each has two digits.
  bool read_data(const Fields& fields, std::size_t at, int bytes, CanFrame& frame) {
    if (fields.size() < at + static_cast<std::size_t>(bytes)) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(bytes); ++i) {
      const auto byte = unsigned_number(fields[at + i], base_, 255);
      if (!byte || (base_ == 16 && fields[at + i].size() != 2)) return false;
      frame.data[i] = static_cast<std::uint8_t>(*byte);
    }
    frame.length = static_cast<std::uint8_t>(bytes);
    return true;
  }

  CanFrame frame_now() const {
    CanFrame frame;
    frame.stamp_us = start_us_ + now_us_;
    return frame;
  }

  /// Reads "0.002367 1 390x Rx d 8 17 00 14 00 C0 00 08 00".
  void classical(const Fields& fields) {
    if (!read_channel(fields[1])) return;  // of LIN, Ethernet and others
    if (lower(fields[2]) == "errorframe") {
      frame_ = plain_error_frame(start_us_ + now_us_);
      return;
    }
    if (!is_direction(fields[3])) return;  // a statistic, J1939TP, a request to send
    CanFrame frame = frame_now();
    if (!read_id(fields[2], frame)) return fail("has no id of 11 bits, or of 29 bits and an x");
    const std::string kind = lower(fields.size() > 4 ? fields[4] : "");
    const auto code = fields.size() > 5 ? unsigned_number(fields[5], base_, 15) : std::nullopt;
    frame.remote = kind == "r";
    if (frame.remote)
      frame.length = static_cast<std::uint8_t>(bytes_of_code(code.value_or(0), false));
    else if (kind != "d" || !code)
      return fail("has no d and data length code, nor r, after its direction");
    else if (!read_data(fields, 6, bytes_of_code(*code, false), frame))
      return fail("has fewer bytes than its data length code says");
    frame_ = frame;
  }

  /// Reads "21.671796 CANFD 1 Tx 11 Name 1 0 a 16 00 .. c0 100000 214 223040 80000000 ...". The
  /// name may be missing. Behind the data are duration, length in bits and flags.
  void flexible(const Fields& fields) {
    constexpr std::uint32_t kRemote = 0x10, kFlexible = 0x1000;
    if (!is_direction(fields[3])) return;
    if (!read_channel(fields[2])) return fail("has no channel from 1 to 255");
    if (fields.size() > 4 && lower(fields[4]) == "errorframe") {
      frame_ = plain_error_frame(start_us_ + now_us_);
      return;
    }
    CanFrame frame = frame_now();
    if (fields.size() < 5 || !read_id(fields[4], frame))
      return fail("has no id of 11 bits, or of 29 bits and an x");
    const bool named =
        fields.size() > 5 && std::isdigit(static_cast<unsigned char>(fields[5][0])) == 0;
    const std::size_t at = named ? 6 : 5;
    if (fields.size() < at + 4) return fail("ends before its data length");
    const auto switched = unsigned_number(fields[at], 10, 1);
    const auto code = unsigned_number(fields[at + 2], base_, 15);
    const auto bytes = unsigned_number(fields[at + 3], 10, 64);
    if (!switched || !code || !bytes || !is_fd_length(static_cast<int>(*bytes)))
      return fail("has no bit rate switch (0, 1), data length code and number of bytes");
    if (!read_data(fields, at + 4, static_cast<int>(*bytes), frame))
      return fail("has fewer bytes than it says");
    const std::size_t flags_at = at + 4 + *bytes + 2;
    const auto flags = fields.size() > flags_at ? unsigned_number(fields[flags_at], 16, 0xFFFFFFFFu)
                                                : std::nullopt;
    frame.bit_rate_switch = *switched == 1;
    frame.fd = !flags || (*flags & kFlexible) != 0 || frame.bit_rate_switch || *bytes > 8;
    frame.remote = !frame.fd && (*flags & kRemote) != 0;
    if (frame.remote) frame.length = static_cast<std::uint8_t>(bytes_of_code(*code, false));
    if (!frame.remote && *bytes != static_cast<unsigned>(bytes_of_code(*code, frame.fd)))
      return fail("has a number of bytes that contradicts its data length code");
    frame_ = frame;
  }

  FileProblems problems_;
  std::optional<int> zone_min_;
  const TakeCanFrame& take_;
  std::vector<std::string>& notes_;
  int base_ = 16;
  bool relative_ = false, started_ = false;
  std::optional<LogDate> date_;
  std::int64_t start_us_ = 0, now_us_ = 0;
  unsigned channel_ = 0;
  std::optional<CanFrame> frame_;  ///< of the line
  const char* rule_ = nullptr;     ///< that the line breaks
};

}  // namespace

bool looks_like_asc(const std::string& path) {
  std::vector<Problem> ignored;
  FileProblems problems(path, ignored);
  LineReader lines(problems);
  std::string_view line;
  Fields fields;
  while (lines.number() < kHeaderLines && lines.next(line)) {
    split_blanks(line, fields);
    if (fields.size() > 1 && lower(fields[0]) == "base" &&
        (lower(fields[1]) == "hex" || lower(fields[1]) == "dec"))
      return true;
  }
  return false;
}

bool read_asc(const std::string& path, std::optional<int> zone_min, const TakeCanFrame& take,
              std::vector<std::string>& notes, std::vector<Problem>& problems) {
  return AscReader(path, zone_min, take, notes, problems).run();
}

}  // namespace framewatch::drivers
