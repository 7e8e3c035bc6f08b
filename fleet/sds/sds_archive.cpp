// SPDX-License-Identifier: MIT
#include "fleet/sds/sds_archive.h"

#include <libmseed.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <system_error>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/miniseed_file.h"
#include "drivers/files/input_file.h"

namespace framewatch::fleet {
namespace {

namespace fs = std::filesystem;
using daemon::kDay_us;

struct FreeParsed {
  void operator()(MSRecord* record) const { msr_free(&record); }
};
using ParsedRecord = std::unique_ptr<MSRecord, FreeParsed>;

struct Sample {
  std::int64_t time_us;
  std::int32_t count;
};
/// A channel on one day.
struct Day {
  std::string location, channel;
  std::int64_t day = 0;  ///< since 1970
  auto operator<=>(const Day&) const = default;
};
struct Samples {
  double rate_hz = 0;
  std::vector<Sample> all;  ///< existing samples first
};

bool is_code(const std::string& code, std::size_t most) {
  return !code.empty() && code.size() <= most && std::all_of(code.begin(), code.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  });
}

/// Adds the samples of records to `days`. Returns an empty text, or the problem.
std::string parse(std::span<const std::uint8_t> bytes, std::map<Day, Samples>& days) {
  std::vector<char> buffer(bytes.begin(), bytes.end());
  for (std::size_t at = 0; at < buffer.size();) {
    MSRecord* parsed = nullptr;
    const int left = static_cast<int>(std::min<std::size_t>(buffer.size() - at, INT32_MAX));
    const int status = msr_parse(buffer.data() + at, left, &parsed, 0, 1, 0);
    const ParsedRecord record(parsed);
    if (status != MS_NOERROR) return fmt::format("expected a miniSEED record at byte {}", at);
    if (record->sampletype != 'i' || !(record->samprate > 0))
      return fmt::format("the record at byte {} does not hold integers", at);
    const auto* counts = static_cast<const std::int32_t*>(record->datasamples);
    for (std::int64_t i = 0; i < record->numsamples; ++i) {
      const std::int64_t time_us =
          record->starttime + std::llround(1e6 * static_cast<double>(i) / record->samprate);
      const std::int64_t day = time_us / kDay_us - (time_us % kDay_us < 0 ? 1 : 0);
      Samples& samples = days[{record->location, record->channel, day}];
      if (samples.rate_hz == 0) samples.rate_hz = record->samprate;
      if (samples.rate_hz != record->samprate)
        return fmt::format("{}.{} has two rates", record->location, record->channel);
      samples.all.push_back({time_us, counts[i]});
    }
    at += static_cast<std::size_t>(record->reclen);
  }
  return {};
}

/// Sorts by time. Of two samples less than half a step apart keeps the one that came first.
void sort_once(Samples& samples) {
  std::stable_sort(samples.all.begin(), samples.all.end(),
                   [](const Sample& a, const Sample& b) { return a.time_us < b.time_us; });
  const double half_us = 0.5e6 / samples.rate_hz;
  const auto last =
      std::unique(samples.all.begin(), samples.all.end(), [&](const Sample& a, const Sample& b) {
        return static_cast<double>(b.time_us - a.time_us) < half_us;
      });
  samples.all.erase(last, samples.all.end());
}

/// Returns the year of a day since 1970, and the number of the day in that year from 1.
std::pair<int, int> year_and_day(std::int64_t day) {
  using namespace std::chrono;
  const sys_days date{days(day)};
  const year y = year_month_day(date).year();
  return {static_cast<int>(y), static_cast<int>((date - sys_days(y / January / 1)).count()) + 1};
}

std::string path_of(const std::string& root, const Day& day, const SdsCodes& codes) {
  const auto [year, number] = year_and_day(day.day);
  return fmt::format("{0}/{1:04}/{2}/{3}/{5}.D/{2}.{3}.{4}.{5}.D.{1:04}.{6:03}", root, year,
                     codes.network, codes.station, day.location, day.channel, number);
}

std::string write_day(const std::string& path, const Day& day, const SdsCodes& codes,
                      const Samples& samples) {
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  daemon::MiniseedFile file({{codes.network, codes.station, day.location, day.channel}},
                            samples.rate_hz);
  bool good = file.open(path);
  for (const Sample& s : samples.all) good = good && file.put(0, s.time_us, s.count);
  return good && file.close() ? "" : fmt::format("{}: {}", path, file.error());
}

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

bool is_network_code(const std::string& code) {
  return is_code(code, 2);
}
bool is_station_code(const std::string& code) {
  return is_code(code, 5);
}

SdsOutcome add_to_sds(const std::string& root, std::span<const std::uint8_t> miniseed,
                      const SdsCodes& codes) {
  SdsOutcome out;
  std::map<Day, Samples> days;
  out.problem = parse(miniseed, days);
  if (!out.problem.empty()) return out;
  for (auto& [day, added] : days) {
    const std::string path = path_of(root, day, codes);
    std::map<Day, Samples> there;
    if (!drivers::is_absent(path)) out.problem = parse(bytes_of(path), there);
    if (out.problem.empty() && !there.empty() &&
        (there.size() > 1 || there.begin()->first != day ||
         there.begin()->second.rate_hz != added.rate_hz))
      out.problem = "the existing file has another channel, day or rate";
    if (!out.problem.empty()) {
      out.problem = fmt::format("{}: {}", path, out.problem);
      return out;
    }
    Samples joined = there.empty() ? Samples{added.rate_hz, {}} : std::move(there.begin()->second);
    sort_once(joined);
    const std::size_t before = joined.all.size();
    joined.all.insert(joined.all.end(), added.all.begin(), added.all.end());
    sort_once(joined);
    if (joined.all.size() == before) continue;
    out.problem = write_day(path, day, codes, joined);
    if (!out.problem.empty()) return out;
    out.samples += static_cast<std::int64_t>(joined.all.size() - before);
    out.files.push_back(path);
  }
  return out;
}

}  // namespace framewatch::fleet
