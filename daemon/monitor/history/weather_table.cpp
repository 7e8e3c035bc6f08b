// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/weather_table.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostColumns = 20;

/// A unit of covariates, and the values that such a thing can have.
struct Unit {
  std::string_view ending;
  double least, most;
};
constexpr Unit kUnits[] = {{"_degc", -60, 80}, {"_pct", 0, 100}, {"_mps", 0, 100}};

const Unit* unit_of(std::string_view name) {
  const auto found = std::find_if(std::begin(kUnits), std::end(kUnits),
                                  [&](const Unit& u) { return name.ends_with(u.ending); });
  return found == std::end(kUnits) ? nullptr : found;
}

class Reader {
 public:
  Reader(const std::string& path, std::vector<drivers::Problem>& problems)
      : problems_(path, problems), lines_(problems_) {}

  WeatherTable read() {
    std::string_view line;
    if (lines_.next(line)) read_header(line);
    if (problems_.any()) return std::move(out_);  // without a header, its rows mean nothing
    while (!problems_.full() && lines_.next(line)) read_row(line);
    if (!problems_.any() && sums_.empty()) problems_.add(0, "no row with a value");
    for (const auto& [day, sums] : sums_) {
      std::vector<double>& means = out_.days[day];
      for (const Sum& s : sums) means.push_back(s.count > 0 ? s.sum / s.count : estimator::kNaN);
    }
    return std::move(out_);
  }

 private:
  struct Sum {
    double sum = 0;
    int count = 0;
  };

  void read_header(std::string_view line) {
    drivers::split_commas(line, cells_);
    if (cells_.size() < 2 || cells_.size() > kMostColumns + 1 || cells_[0] != "time") {
      problems_.add(1, fmt::format("the header must be time and 1 to {} covariates, such as "
                                   "time,outside_degc,humidity_pct",
                                   kMostColumns));
      return;
    }
    for (std::size_t c = 1; c < cells_.size(); ++c) {
      const std::string name(cells_[c]);
      const Unit* unit = unit_of(name);
      if (unit == nullptr)
        problems_.add(1, fmt::format("{}: the name must end with its unit: _degc, _pct or _mps",
                                     drivers::show_text(name)));
      else
        units_.push_back(unit);
      out_.covariates.push_back({name, name.ends_with("_degc")});
    }
  }

  void read_row(std::string_view line) {
    drivers::split_commas(line, cells_);
    if (cells_.size() == 1 && cells_[0].empty()) return;
    if (cells_.size() != units_.size() + 1) {
      problems_.add(lines_.number(), fmt::format("{} cells, and the header has {}", cells_.size(),
                                                 units_.size() + 1));
      return;
    }
    const auto time_us = read_utc(std::string(cells_[0]));
    if (!time_us) {
      problems_.add(lines_.number(),
                    drivers::show_text(cells_[0]) + " is not a time such as 2026-11-21T23:15:00Z");
      return;
    }
    std::vector<Sum>& sums = sums_[day_of(*time_us)];
    sums.resize(units_.size());
    for (std::size_t c = 0; c < units_.size(); ++c) {
      const auto value = drivers::parse_sample(cells_[c + 1]);
      if (!value || *value < units_[c]->least || *value > units_[c]->most) {
        problems_.add(
            lines_.number(),
            fmt::format("{}: {} is not between {} and {}", out_.covariates[c].name,
                        drivers::show_text(cells_[c + 1]), units_[c]->least, units_[c]->most));
        continue;
      }
      if (!std::isfinite(*value)) continue;
      sums[c].sum += *value;
      ++sums[c].count;
    }
  }

  static std::int64_t day_of(std::int64_t time_us) {
    return time_us / kDay_us - (time_us % kDay_us < 0 ? 1 : 0);
  }

  drivers::FileProblems problems_;
  drivers::LineReader lines_;
  std::vector<std::string_view> cells_;
  std::vector<const Unit*> units_;
  std::map<std::int64_t, std::vector<Sum>> sums_;
  WeatherTable out_;
};

}  // namespace

std::vector<double> WeatherTable::of(std::int64_t day) const {
  const auto found = days.find(day);
  return found == days.end() ? std::vector<double>(covariates.size(), estimator::kNaN)
                             : found->second;
}

std::optional<WeatherTable> read_weather(const std::string& path,
                                         std::vector<std::string>& problems) {
  std::vector<drivers::Problem> found;
  WeatherTable out = Reader(path, found).read();
  for (const drivers::Problem& p : found) problems.push_back(p.where + ": " + p.message);
  if (!found.empty()) return std::nullopt;
  return out;
}

}  // namespace framewatch::daemon
