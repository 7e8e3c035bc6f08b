// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/weather_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/keys/weather_options.h"
#include "daemon/monitor/history/history_days.h"
#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostColumns = 20;

struct Sum {
  double sum = 0;
  int count = 0;
};
using SumsByDay = std::map<std::int64_t, std::vector<Sum>>;

void put_means(const SumsByDay& days, WeatherTable& out) {
  for (const auto& [day, sums] : days) {
    std::vector<double>& means = out.days[day];
    for (const Sum& s : sums) means.push_back(s.count > 0 ? s.sum / s.count : estimator::kNaN);
  }
}

estimator::Covariate covariate_of(const std::string& name, const CovariateUnit& unit) {
  return {name, unit.freezes, unit.scale};
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
    put_means(sums_, out_);
    return std::move(out_);
  }

 private:
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
      const CovariateUnit* unit = covariate_unit(name);
      if (unit == nullptr) {
        problems_.add(1, fmt::format("{}: the name must end with its unit: {}",
                                     drivers::show_text(name), covariate_endings()));
        continue;
      }
      units_.push_back(unit);
      out_.covariates.push_back(covariate_of(name, *unit));
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
    std::vector<Sum>& sums = sums_[floor_day(*time_us)];
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

  drivers::FileProblems problems_;
  drivers::LineReader lines_;
  std::vector<std::string_view> cells_;
  std::vector<const CovariateUnit*> units_;
  SumsByDay sums_;
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

std::vector<estimator::Covariate> covariates_of(const std::vector<std::string>& names) {
  std::vector<estimator::Covariate> out;
  for (const std::string& name : names) out.push_back(covariate_of(name, *covariate_unit(name)));
  return out;
}

WeatherTable weather_of(const std::vector<WeatherHour>& hours,
                        const std::vector<std::string>& covariates) {
  WeatherTable out;
  out.covariates = covariates_of(covariates);
  SumsByDay days;
  for (const WeatherHour& hour : hours) {
    const auto at = std::ranges::find(covariates, hour.name);
    if (at == covariates.end() || !std::isfinite(hour.mean)) continue;
    std::vector<Sum>& sums = days[floor_day(hour.start_us)];
    sums.resize(covariates.size());
    Sum& of = sums[static_cast<std::size_t>(at - covariates.begin())];
    of.sum += hour.mean;
    ++of.count;
  }
  put_means(days, out);
  return out;
}

std::string weather_csv(const std::vector<WeatherHour>& hours) {
  std::string header = "time";
  std::vector<std::string> names;
  std::map<std::int64_t, std::map<std::string, double>> rows;
  for (const WeatherHour& hour : hours) {
    if (std::ranges::find(names, hour.name) == names.end()) names.push_back(hour.name);
    rows[hour.start_us][hour.name] = hour.mean;
  }
  for (const std::string& name : names) header += "," + csv_text(name);
  std::string out = header + "\n";
  for (const auto& [start_us, row] : rows) {
    out += utc_text(start_us);
    for (const std::string& name : names) {
      const auto found = row.find(name);
      out += ',';
      if (found != row.end()) out += drivers::format_number(found->second);
    }
    out += '\n';
  }
  return out;
}

}  // namespace framewatch::daemon
