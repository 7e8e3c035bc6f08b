#include "daemon/history_files.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <fmt/core.h>

#include "daemon/clocks.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;
namespace ch = std::chrono;

constexpr const char* kEnding = ".lcmlog";
constexpr std::string_view kPartial = ".partial", kPacked = ".zst";
constexpr std::size_t kStampLength = 16;  // 20261121T231500Z

struct Civil {
  int year;
  unsigned month, day;
  int hour, minute, second, microsecond;
};

Civil civil(std::int64_t time_us) {
  const ch::sys_time<ch::microseconds> time{ch::microseconds(time_us)};
  const auto day = ch::floor<ch::days>(time);
  const ch::year_month_day date(day);
  const ch::hh_mm_ss clock(time - day);
  return {static_cast<int>(date.year()),
          static_cast<unsigned>(date.month()),
          static_cast<unsigned>(date.day()),
          static_cast<int>(clock.hours().count()),
          static_cast<int>(clock.minutes().count()),
          static_cast<int>(clock.seconds().count()),
          static_cast<int>(clock.subseconds().count())};
}

std::optional<std::int64_t> microseconds(int year, int month, int day, int hour, int minute,
                                         double second) {
  const ch::year_month_day date{ch::year(year), ch::month(static_cast<unsigned>(month)),
                                ch::day(static_cast<unsigned>(day))};
  if (!date.ok() || hour < 0 || hour > 24 || minute < 0 || minute > 59 || !(second >= 0) ||
      second >= 61)
    return std::nullopt;
  const std::int64_t days = ch::sys_days(date).time_since_epoch().count();
  return ((days * 24 + hour) * 60 + minute) * 60 * kSecond_us + std::llround(second * 1e6);
}

/// The number that is all of a text.
template <typename Number>
bool whole(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return !text.empty() && error == std::errc() && end == text.data() + text.size();
}

std::string stamp(std::int64_t time_us) {
  const Civil c = civil(time_us);
  return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}Z", c.year, c.month, c.day, c.hour, c.minute,
                     c.second);
}

std::optional<std::int64_t> read_stamp(std::string_view s) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (s.size() < kStampLength || s[8] != 'T' || s[15] != 'Z' || !whole(s.substr(0, 4), year) ||
      !whole(s.substr(4, 2), month) || !whole(s.substr(6, 2), day) ||
      !whole(s.substr(9, 2), hour) || !whole(s.substr(11, 2), minute) ||
      !whole(s.substr(13, 2), second))
    return std::nullopt;
  return microseconds(year, month, day, hour, minute, second);
}

std::optional<RawLog> raw_log(const fs::directory_entry& entry) {
  RawLog log;
  log.path = entry.path().string();
  std::string name = entry.path().filename().string();
  const auto take = [&name](std::string_view ending) {
    if (!name.ends_with(ending)) return false;
    name.resize(name.size() - ending.size());
    return true;
  };
  log.partial = take(kPartial);
  log.compressed = take(kPacked);
  if (!take(kEnding) || (log.partial && log.compressed)) return std::nullopt;
  const auto start_us = read_stamp(name);
  if (!start_us) return std::nullopt;
  log.start_us = *start_us;
  std::error_code failure;
  log.bytes = static_cast<std::int64_t>(entry.file_size(failure));
  if (failure == std::errc::no_such_file_or_directory)
    log.bytes = 0;  // it has got its next name
  else if (failure)
    return std::nullopt;
  return log;
}

}  // namespace

std::string raw_folder(const std::string& directory) {
  return (fs::path(directory) / "raw").string();
}

std::string event_folder(const std::string& directory) {
  return (fs::path(directory) / "events").string();
}

std::string summary_file(const std::string& directory) {
  return (fs::path(directory) / "history.sqlite").string();
}

std::string new_raw_log(const std::string& directory, std::int64_t start_us) {
  const fs::path folder = raw_folder(directory);
  std::error_code none;
  fs::create_directories(folder, none);  // that it is not there shows when the file is made
  std::string name = stamp(start_us);
  for (int i = 2;; ++i) {
    const std::string path = (folder / (name + kEnding)).string();
    bool there = false;
    for (const char* ending : {"", ".zst", ".partial"})
      there = there || fs::exists(path + ending, none);
    if (!there) return path;
    name = fmt::format("{}_{}", stamp(start_us), i);
  }
}

std::vector<RawLog> raw_logs(const std::string& folder) {
  std::vector<RawLog> out;
  std::error_code none;
  for (fs::directory_iterator at(folder, none), end; !none && at != end; at.increment(none))
    if (const auto log = raw_log(*at)) out.push_back(*log);
  std::sort(out.begin(), out.end(), [](const RawLog& a, const RawLog& b) {
    return std::pair(a.start_us, a.path) < std::pair(b.start_us, b.path);
  });
  const auto there = [&](const std::string& path) {
    return std::any_of(out.begin(), out.end(), [&](const RawLog& log) { return log.path == path; });
  };
  std::vector<RawLog> once;
  for (const RawLog& log : out) {
    const std::string closed = closed_path(log);
    const bool later =
        !log.compressed && ((log.partial && there(closed)) || there(closed + ".zst"));
    if (!later) once.push_back(log);
  }
  return once;
}

std::string closed_path(const RawLog& log) {
  const std::size_t ending = log.partial ? kPartial.size() : log.compressed ? kPacked.size() : 0;
  return log.path.substr(0, log.path.size() - ending);
}

std::string utc_text(std::int64_t time_us) {
  const Civil c = civil(time_us);
  std::string out = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", c.year, c.month, c.day,
                                c.hour, c.minute, c.second);
  if (c.microsecond != 0) out += fmt::format(".{:03}", c.microsecond / 1000);
  return out + "Z";
}

std::optional<std::int64_t> read_utc(const std::string& text) {
  if (double seconds = 0; whole(std::string_view(text), seconds)) {
    if (!(std::abs(seconds) < 9e9)) return std::nullopt;
    return std::llround(seconds * 1e6);
  }
  std::string_view s = text;
  if (s.ends_with('Z')) s.remove_suffix(1);
  int year = 0, month = 0, day = 0, hour = 0, minute = 0;
  double second = 0;
  if (s.size() < 10 || s[4] != '-' || s[7] != '-' || !whole(s.substr(0, 4), year) ||
      !whole(s.substr(5, 2), month) || !whole(s.substr(8, 2), day))
    return std::nullopt;
  if (s.size() == 10) return microseconds(year, month, day, 0, 0, 0);
  if (s.size() < 16 || (s[10] != 'T' && s[10] != ' ') || s[13] != ':' ||
      !whole(s.substr(11, 2), hour) || !whole(s.substr(14, 2), minute))
    return std::nullopt;
  if (s.size() > 16 && (s[16] != ':' || !whole(s.substr(17), second))) return std::nullopt;
  return microseconds(year, month, day, hour, minute, second);
}

}  // namespace framewatch::daemon
