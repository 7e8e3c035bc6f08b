// SPDX-License-Identifier: MIT
#include "drivers/records/record_builder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "estimator/numeric/quantile.h"

namespace framewatch::drivers {
namespace {

/// Relative error of the step estimated from single steps; it adds up over lost samples.
constexpr double kRateError = 1e-4;

constexpr double kRateTolerance = 1e-3;

/// The place of a record on the grid of the first record.
struct Placed {
  std::int64_t first = 0;  ///< index in the grid of the record's first instant
  std::int64_t last = 0;
};

double grid_position(const Record& grid, double time_s) {
  return (time_s - grid.time_s.front()) * grid.rate_hz;
}

std::optional<Placed> place(const Record& grid, const Record& record, const std::string& where,
                            std::vector<Problem>& problems) {
  const auto refuse = [&](const std::string& why) {
    problems.push_back({where, why});
    return std::nullopt;
  };
  if (std::abs(record.rate_hz / grid.rate_hz - 1) > kRateTolerance)
    return refuse(fmt::format("rates differ: {:.6g} Hz, but the first has {:.6g} Hz",
                              record.rate_hz, grid.rate_hz));
  const double begin = grid_position(grid, record.time_s.front());
  const Placed placed{std::llround(begin),
                      std::llround(begin) + static_cast<std::int64_t>(record.time_s.size()) - 1};
  const std::int64_t grid_last = static_cast<std::int64_t>(grid.time_s.size()) - 1;
  if (placed.last < 0 || placed.first > grid_last)
    return refuse(fmt::format(
        "the clocks do not overlap: {:.6f} to {:.6f} s, but the first has "
        "{:.6f} to {:.6f} s",
        record.time_s.front(), record.time_s.back(), grid.time_s.front(), grid.time_s.back()));
  for (const std::int64_t at :
       {std::max<std::int64_t>(0, placed.first), std::min(grid_last, placed.last)}) {
    const double theirs = record.time_s[static_cast<std::size_t>(at - placed.first)];
    const double apart = (theirs - grid.time_s[static_cast<std::size_t>(at)]) * grid.rate_hz;
    if (std::abs(apart) <= RecordBuilder::kStepTolerance) continue;
    return refuse(
        fmt::format("the clocks are not synchronized: at {:.6f} s its samples lie "
                    "{:.2f} steps off the first one's",
                    theirs, apart));
  }
  return placed;
}

bool holds(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

/// Returns the notes that all of several records have.
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

RecordBuilder::RecordBuilder(std::vector<std::string> names, FileProblems& problems)
    : problems_(problems) {
  record_.names = std::move(names);
  record_.accel_mps2.resize(record_.names.size());
}

void RecordBuilder::add(std::int64_t line, double time_s, std::span<const double> accel_mps2) {
  if (full_) return;
  if ((rows() + 1) * (record_.names.size() + 1) > kMaxValues) {
    problems_.add(line, fmt::format("a record holds at most {} values", kMaxValues));
    full_ = true;
    return;
  }
  if (!std::isfinite(time_s) || std::abs(time_s) > kMaxTimeS) {
    problems_.add(line, fmt::format("time must be a number within +-{:g} s", kMaxTimeS));
    return;
  }
  if (!record_.time_s.empty() && !(time_s > record_.time_s.back())) {
    problems_.add(line, fmt::format("time must increase: {} s comes after {} s", time_s,
                                    record_.time_s.back()));
    return;
  }
  for (std::size_t i = 0; i < accel_mps2.size(); ++i) {
    if (!std::isinf(accel_mps2[i])) continue;
    problems_.add(line, fmt::format("{}: in m/s2 the value is more than a number can hold",
                                    record_.names[i]));
    return;
  }
  record_.time_s.push_back(time_s);
  record_.lines.push_back(line);
  for (std::size_t i = 0; i < accel_mps2.size(); ++i)
    record_.accel_mps2[i].push_back(accel_mps2[i]);
}

void RecordBuilder::expect(double rate_hz, std::size_t missing) {
  expected_rate_hz_ = rate_hz;
  missing_allowed_ = missing;
}

double RecordBuilder::even_step() const {
  std::vector<double> steps(rows() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i)
    steps[i] = record_.time_s[i + 1] - record_.time_s[i];
  double usual = 1 / expected_rate_hz_;
  if (expected_rate_hz_ == 0) usual = estimator::lower_median(steps);
  // The median step is wrong when times are rounded, to 1 ms for example; the mean is right.
  double sum = 0;
  double count = 0;
  for (const double step : steps) {
    if (step < 0.5 * usual || step > 1.5 * usual) continue;
    sum += step;
    count += 1;
  }
  return count > 0 ? sum / count : usual;
}

void RecordBuilder::fill_lost_samples(double step) {
  const std::vector<double> time = std::move(record_.time_s);
  std::vector<std::size_t> missing_before(time.size(), 0);
  std::size_t missing = 0;
  const std::size_t most = std::max(time.size(), missing_allowed_);
  for (std::size_t i = 1; i < time.size(); ++i) {
    const double steps = (time[i] - time[i - 1]) / step;
    const double whole = std::max(1.0, std::round(steps));
    if (std::abs(steps - whole) > kStepTolerance + kRateError * (whole - 1))
      problems_.add(record_.lines[i],
                    fmt::format("uneven step: {:.6g} s where the others are {:.6g} s",
                                time[i] - time[i - 1], step));
    if (whole - 1 > static_cast<double>(most - missing)) {
      problems_.add(record_.lines[i],
                    fmt::format("a loss of {:.6g} s: more samples are missing than the "
                                "record has",
                                time[i] - time[i - 1]));
      break;
    }
    missing_before[i] = static_cast<std::size_t>(whole) - 1;
    missing += missing_before[i];
  }
  record_.time_s = time;
  if (problems_.any() || missing == 0) return;

  std::vector<double> filled_time;
  std::vector<std::int64_t> filled_lines;
  for (std::size_t i = 0; i < time.size(); ++i) {
    filled_lines.insert(filled_lines.end(), missing_before[i], 0);
    filled_lines.push_back(record_.lines[i]);
    for (std::size_t k = missing_before[i]; k > 0; --k)
      filled_time.push_back(time[i] - static_cast<double>(k) * (time[i] - time[i - 1]) /
                                          static_cast<double>(missing_before[i] + 1));
    filled_time.push_back(time[i]);
  }
  record_.time_s = std::move(filled_time);
  record_.lines = std::move(filled_lines);
  for (std::vector<double>& axis : record_.accel_mps2) {
    std::vector<double> filled;
    filled.reserve(rows());
    for (std::size_t i = 0; i < time.size(); ++i) {
      filled.insert(filled.end(), missing_before[i], std::numeric_limits<double>::quiet_NaN());
      filled.push_back(axis[i]);
    }
    axis = std::move(filled);
  }
  note(fmt::format("{} instants are missing and were filled with NaN", missing));
}

std::optional<Record> RecordBuilder::finish() {
  if (problems_.any()) return std::nullopt;
  const std::size_t least = expected_rate_hz_ > 0 ? 1 : 2;
  if (rows() < least)
    return problems_.add(
        0, fmt::format("a record needs at least {} samples, this one has {}", least, rows()));
  const double step = even_step();
  if (step * kMaxRateHz < 1)
    return problems_.add(
        0, fmt::format("step {:.3g} s: rates above {:g} Hz are not supported", step, kMaxRateHz));
  for (std::size_t i = 0; i < record_.names.size(); ++i) {
    const auto& values = record_.accel_mps2[i];
    const auto missing =
        std::count_if(values.begin(), values.end(), [](double v) { return std::isnan(v); });
    if (missing > 0)
      note(fmt::format("{}: {} of {} samples have no value", record_.names[i], missing, rows()));
  }
  fill_lost_samples(step);
  if (problems_.any()) return std::nullopt;
  record_.rate_hz = 1 / step;
  return std::move(record_);
}

void check_names(const std::vector<std::string>& names, std::int64_t line, FileProblems& problems) {
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty())
      problems.add(line, "a channel name is empty");
    else if (name.find_first_of("\",") != std::string::npos)
      problems.add(
          line, fmt::format("channel name {} must not contain quotes or commas", show_text(name)));
    else if (!seen.insert(name).second)
      problems.add(line, fmt::format("channel name {} appears twice", show_text(name)));
  }
}

std::string name_of_file(const std::string& path) {
  std::filesystem::path name = std::filesystem::path(path).filename();
  if (name.extension() == ".gz") name = name.stem();
  std::string stem = name.stem().string();
  for (char& c : stem)
    if (c == ',' || c == '"') c = '_';
  return stem;
}

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
  // The caller names the file beside its notes.
  const bool one_file = std::all_of(where.begin(), where.end(),
                                    [&](const std::string& file) { return file == where[0]; });
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Placed& p = places[i];
    const std::string from = one_file ? "" : where[i] + ": ";
    for (const std::string& note : records[i].notes)
      if (!holds(common, note)) merged.notes.push_back(from + note);
    if (span == MergeSpan::common && (p.first < first || p.last > last))
      merged.notes.push_back(fmt::format(
          "{}{} instants outside the common span left out", from,
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
  for (const std::string& note : common) merged.notes.push_back("all records: " + note);
  return merged;
}

}  // namespace framewatch::drivers
