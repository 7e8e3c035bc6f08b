#include "drivers/records/record_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/core.h>

#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr double kRateTolerance = 1e-3;

/// Where a record lies on the first one's grid: its instant i is the grid's first + i.
struct Placed {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

double grid_position(const Record& grid, double time_s) {
  return (time_s - grid.time_s.front()) * grid.rate_hz;
}

std::optional<Placed> place(const Record& grid, const Record& record, const std::string& where,
                            std::vector<Problem>& problems) {
  if (std::abs(record.rate_hz / grid.rate_hz - 1) > kRateTolerance) {
    problems.push_back({where, fmt::format("rates differ: {:.6g} Hz, but the first has {:.6g} Hz",
                                           record.rate_hz, grid.rate_hz)});
    return std::nullopt;
  }
  const double begin = grid_position(grid, record.time_s.front());
  const Placed placed{std::llround(begin),
                      std::llround(begin) + static_cast<std::int64_t>(record.time_s.size()) - 1};
  const std::int64_t grid_last = static_cast<std::int64_t>(grid.time_s.size()) - 1;
  if (placed.last < 0 || placed.first > grid_last) {
    problems.push_back(
        {where, fmt::format("the clocks do not overlap: {:.6f} to {:.6f} s, but the first has "
                            "{:.6f} to {:.6f} s",
                            record.time_s.front(), record.time_s.back(), grid.time_s.front(),
                            grid.time_s.back())});
    return std::nullopt;
  }
  for (const std::int64_t at :
       {std::max<std::int64_t>(0, placed.first), std::min(grid_last, placed.last)}) {
    const double theirs = record.time_s[static_cast<std::size_t>(at - placed.first)];
    const double apart = (theirs - grid.time_s[static_cast<std::size_t>(at)]) * grid.rate_hz;
    if (std::abs(apart) <= RecordBuilder::kStepTolerance) continue;
    problems.push_back({where, fmt::format("the clocks are not synchronised: at {:.6f} s its "
                                           "samples lie {:.2f} steps off the first one's",
                                           theirs, apart)});
    return std::nullopt;
  }
  return placed;
}

bool holds(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

/// What is noted of every one of several records; said once.
std::vector<std::string> common_notes(const std::vector<Record>& records) {
  std::vector<std::string> out;
  if (records.size() < 2) return out;
  for (const std::string& note : records[0].notes)
    if (std::all_of(records.begin(), records.end(),
                    [&](const Record& r) { return holds(r.notes, note); }))
      out.push_back(note);
  return out;
}

double grid_time(const Record& grid, std::int64_t at) {
  const std::int64_t last = static_cast<std::int64_t>(grid.time_s.size()) - 1;
  if (at >= 0 && at <= last) return grid.time_s[static_cast<std::size_t>(at)];
  const double edge = at < 0 ? grid.time_s.front() : grid.time_s.back();
  return edge + static_cast<double>(at < 0 ? at : at - last) / grid.rate_hz;
}

}  // namespace

std::optional<Record> merge_records(std::vector<Record> records,
                                    const std::vector<std::string>& where, MergeSpan span,
                                    std::vector<Problem>& problems) {
  if (records.empty()) return std::nullopt;
  const std::size_t problems_before = problems.size();
  std::vector<Placed> places;
  std::set<std::string> names;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto placed = place(records[0], records[i], where[i], problems);
    places.push_back(placed.value_or(Placed{}));
    for (const std::string& name : records[i].names)
      if (!names.insert(name).second)
        problems.push_back({where[i], fmt::format("channel name {} appears twice", name)});
  }
  if (problems.size() > problems_before) return std::nullopt;

  std::int64_t first = places[0].first;
  std::int64_t last = places[0].last;
  for (const Placed& p : places) {
    first = span == MergeSpan::common ? std::max(first, p.first) : std::min(first, p.first);
    last = span == MergeSpan::common ? std::min(last, p.last) : std::max(last, p.last);
  }
  if (last - first < 1) {
    problems.push_back({where[0], "the clocks do not overlap: fewer than 2 common instants"});
    return std::nullopt;
  }
  Record merged;
  const std::vector<std::string> common = common_notes(records);
  merged.rate_hz = records[0].rate_hz;
  for (std::int64_t at = first; at <= last; ++at)
    merged.time_s.push_back(grid_time(records[0], at));
  const bool any_header = std::any_of(records.begin(), records.end(),
                                      [](const Record& r) { return !r.headers.empty(); });
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Placed& p = places[i];
    for (const std::string& note : records[i].notes)
      if (!holds(common, note)) merged.notes.push_back(fmt::format("{}: {}", where[i], note));
    if (span == MergeSpan::common && (p.first < first || p.last > last))
      merged.notes.push_back(fmt::format(
          "{}: {} instants outside the common span left out", where[i],
          std::max<std::int64_t>(0, first - p.first) + std::max<std::int64_t>(0, p.last - last)));
    for (std::size_t c = 0; c < records[i].names.size(); ++c) {
      merged.names.push_back(records[i].names[c]);
      if (any_header)
        merged.headers.push_back(records[i].headers.empty() ? AxisHeader{} : records[i].headers[c]);
      auto& column = merged.accel_mps2.emplace_back(merged.time_s.size(),
                                                    std::numeric_limits<double>::quiet_NaN());
      const auto& source = records[i].accel_mps2[c];
      for (std::int64_t at = std::max(first, p.first); at <= std::min(last, p.last); ++at)
        column[static_cast<std::size_t>(at - first)] =
            source[static_cast<std::size_t>(at - p.first)];
    }
  }
  for (const std::string& note : common) merged.notes.push_back("all of them: " + note);
  return merged;
}

}  // namespace framewatch::drivers
