// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr int kMaxHeaderLines = 20;
constexpr std::int64_t kClockPeriodUs = std::int64_t{1} << 32;
constexpr std::array<std::string_view, 5> kColumns = {"PacketCounter", "SampleTimeFine", "Acc_X",
                                                      "Acc_Y", "Acc_Z"};

struct XsensColumns {
  std::size_t count = 0;
  std::array<std::size_t, kColumns.size()> index{};
};

std::optional<XsensColumns> read_xsens_header(LineReader& lines, FileProblems& problems) {
  std::string_view line;
  std::vector<std::string_view> fields;
  while (lines.next(line) && lines.number() <= kMaxHeaderLines) {
    split_commas(line, fields);
    if (fields.front() != kColumns[0]) continue;
    XsensColumns columns{fields.size(), {}};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto found = std::find(fields.begin(), fields.end(), kColumns[i]);
      columns.index[i] = static_cast<std::size_t>(found - fields.begin());
      if (found == fields.end())
        problems.add(lines.number(), fmt::format("Xsens: there is no column {}", kColumns[i]));
      else if (std::count(fields.begin(), fields.end(), kColumns[i]) > 1)
        problems.add(lines.number(), fmt::format("Xsens: column {} appears twice", kColumns[i]));
    }
    if (problems.any()) return std::nullopt;
    return columns;
  }
  if (!problems.any())
    problems.add(0, fmt::format("Xsens: no header PacketCounter,SampleTimeFine,... in the first {} "
                                "lines",
                                kMaxHeaderLines));
  return std::nullopt;
}

/// Continues the device's 32-bit microsecond clock over its wraps.
class DeviceClock {
 public:
  /// Returns the seconds on a clock that does not wrap.
  double advance(std::int64_t stamp_us) {
    if (started_ && stamp_us - last_us_ < -kClockPeriodUs / 2) base_us_ += kClockPeriodUs;
    started_ = true;
    last_us_ = stamp_us;
    return static_cast<double>(base_us_ + stamp_us) / 1e6;
  }
  bool wrapped() const { return base_us_ > 0; }

 private:
  std::int64_t base_us_ = 0;
  std::int64_t last_us_ = 0;
  bool started_ = false;
};

class XsensReader {
 public:
  XsensReader(const XsensColumns& columns, FileProblems& problems)
      : columns_(columns), problems_(problems), builder_({"x", "y", "z"}, problems) {}

  void add(std::int64_t line, const std::vector<std::string_view>& fields) {
    const std::string_view stamp_text = fields[columns_.index[1]];
    const auto stamp_us = parse_integer(stamp_text);
    const bool no_time = !stamp_us && std::isnan(parse_sample(stamp_text).value_or(0));
    if (!stamp_us && !no_time)
      problems_.add(line,
                    fmt::format("SampleTimeFine {}: not a whole number", show_text(stamp_text)));
    if (stamp_us && (*stamp_us < 0 || *stamp_us >= kClockPeriodUs))
      problems_.add(line, fmt::format("SampleTimeFine {}: not within 32 bits", *stamp_us));
    std::array<double, 3> accel_mps2{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view text = fields[columns_.index[i + 2]];
      const auto value = parse_sample(text);
      if (!value)
        problems_.add(line, fmt::format("{}: {} is neither a finite number nor nan",
                                        kColumns[i + 2], show_text(text)));
      accel_mps2[i] = value.value_or(0);
    }
    if (no_time) {
      ++rows_without_time_;
      return;
    }
    if (problems_.any()) return;
    check_counter(fields[columns_.index[0]]);
    const bool first = !std::exchange(started_, true);
    const double time_s = clock_.advance(*stamp_us);
    if (first && accel_mps2 == std::array<double, 3>{}) {
      builder_.note(fmt::format("line {}: the all-zero first row was dropped", line));
      return;
    }
    builder_.add(line, time_s, accel_mps2);
  }

  std::optional<Record> finish() {
    if (counter_jumps_ > 0)
      builder_.note(fmt::format("PacketCounter jumps {} times: samples were lost", counter_jumps_));
    if (rows_without_time_ > 0)
      builder_.note(fmt::format("{} rows without SampleTimeFine were dropped", rows_without_time_));
    if (clock_.wrapped()) builder_.note("SampleTimeFine wraps at 2^32 us; continued");
    builder_.note("Acc_X, Acc_Y, Acc_Z include gravity, as the device gives them");
    return builder_.finish();
  }

  bool full() const { return builder_.full(); }
  void note(const std::string& text) { builder_.note(text); }

 private:
  void check_counter(std::string_view text) {
    const auto counter = parse_integer(text);
    if (counter && last_counter_ && *counter != *last_counter_ + 1) ++counter_jumps_;
    if (counter) last_counter_ = counter;
  }

  XsensColumns columns_;
  FileProblems& problems_;
  RecordBuilder builder_;
  DeviceClock clock_;
  std::optional<std::int64_t> last_counter_;
  bool started_ = false;
  int counter_jumps_ = 0;
  int rows_without_time_ = 0;
};

}  // namespace

std::optional<Record> read_xsens(FileProblems& problems) {
  LineReader lines(problems);
  const auto columns = read_xsens_header(lines, problems);
  if (!columns) return std::nullopt;
  XsensReader reader(*columns, problems);
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line) && !problems.full() && !reader.full();) {
    if (trimmed(line).empty()) continue;
    if (!lines.line_ended()) {
      reader.note(lines.left_out_note("row"));
      continue;
    }
    split_commas(line, fields);
    if (fields.size() == columns->count)
      reader.add(lines.number(), fields);
    else
      problems.add(lines.number(),
                   fmt::format("{} fields where the header has {}", fields.size(), columns->count));
  }
  return reader.finish();
}

}  // namespace framewatch::drivers
