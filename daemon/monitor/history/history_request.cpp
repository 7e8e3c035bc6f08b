// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/history_request.h"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/picture_files.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/files/standard_streams.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kScreenRows = 30;

/// Returns the rule that the name of an export breaks; empty if the name is valid.
std::string problem_of_raw_name(const std::string& path) {
  if (path == drivers::kStandardOutput) return {};
  for (const char* ending : {".lcmlog", ".csv", ".csv.gz", ".mseed"})
    if (path.ends_with(ending)) return {};
  return path + ": the name for raw samples must end in .lcmlog, .csv, .csv.gz or .mseed";
}

class RequestReader {
 public:
  RequestReader(const HistoryArguments& arguments, SummaryQuery& summaries,
                std::vector<std::string>& problems)
      : a_(arguments), summaries_(summaries), problems_(problems) {}

  HistoryRequest read() {
    find_directory();
    check_names();
    if (r_.directory.empty()) return std::move(r_);
    if (const std::string why = summaries_.open(r_.directory); !why.empty()) {
      problem(fmt::format("{}: {}", summary_file(r_.directory), why));
    } else {
      read_span();
      choose_parameters();
    }
    if (const std::string why = summaries_.problem(); problems_.empty() && !why.empty())
      problem(fmt::format("{}: {}", summary_file(r_.directory), why));
    return std::move(r_);
  }

 private:
  void problem(std::string message) { problems_.push_back(std::move(message)); }

  void find_directory() {
    std::error_code none;
    if (std::filesystem::is_directory(a_.place, none)) {
      r_.directory = a_.place;
      return;
    }
    std::vector<ConfigProblem> found;
    r_.config = load_config(a_.place, found);
    for (const ConfigProblem& p : found) problem(fmt::format("{}: {}", p.where, p.message));
    if (r_.config && !r_.config->history)
      problem(a_.place + ": has no [history], so nothing is stored: see docs/history.md");
    if (r_.config && r_.config->history) r_.directory = r_.config->history->directory;
  }

  void check_names() {
    if (!a_.out.empty() && a_.out != drivers::kStandardOutput && !a_.out.ends_with(".csv") &&
        !a_.out.ends_with(".csv.gz") && !a_.out.ends_with(".mat"))
      problem(a_.out + ": the name for summaries must end in .csv, .csv.gz or .mat");
    const bool of_years = a_.losses || !a_.report.empty();
    if (of_years && (!a_.out.empty() || !a_.raw.empty() || a_.events))
      problem("--losses and --report cannot be combined with --out, --raw or --events");
    if (!a_.weather_out.empty() && !a_.weather_out.ends_with(".csv") &&
        !a_.weather_out.ends_with(".csv.gz"))
      problem(a_.weather_out + ": the name for weather must end in .csv or .csv.gz");
    if (!a_.weather.empty() && !of_years) problem("--weather needs --losses or --report");
    if (const std::string rule = problem_of_page_name(a_.report); !rule.empty()) problem(rule);
    if (!a_.raw.empty())
      if (const std::string rule = problem_of_raw_name(a_.raw); !rule.empty()) problem(rule);
    const auto code = [&](const char* option, const std::string& text, std::size_t most) {
      const bool good = !text.empty() && text.size() <= most &&
                        std::all_of(text.begin(), text.end(), [](unsigned char c) {
                          return std::isdigit(c) != 0 || (c >= 'A' && c <= 'Z');
                        });
      if (!good)
        problem(fmt::format("{}: expected at most {} capital letters and digits, got \"{}\"",
                            option, most, text));
    };
    code("--network", a_.network, 2);
    code("--station", a_.station, 5);
  }

  void read_span() {
    const std::vector<SummaryPeriods> periods = summaries_.periods();
    std::int64_t newest_us = summaries_.newest_us().value_or(INT64_MIN);
    for (const RawLog& log : raw_logs(raw_folder(r_.directory)))
      newest_us = std::max(newest_us, log.start_us + kSecond_us);
    const auto time = [&](const char* option, const std::string& text, std::int64_t& out) {
      if (text.empty()) return;
      if (const auto read = read_utc(text))
        out = *read;
      else
        problem(fmt::format("{}: \"{}\" is not a time such as 2026-11-21T23:15:00Z", option, text));
    };
    time("--from", a_.from, r_.from_us);
    time("--to", a_.to, r_.to_us);
    if (!a_.last.empty()) {
      const auto duration = read_duration(a_.last);
      if (!a_.from.empty() || !a_.to.empty())
        problem("--last cannot be combined with --from or --to");
      else if (!duration)
        problem(fmt::format("--last: \"{}\" is not a duration such as 90m, 2h or 3d", a_.last));
      else if (newest_us != INT64_MIN)
        r_.from_us = newest_us - *duration;
    }
    if (r_.from_us >= r_.to_us) problem("--from must be before --to");
    choose_period(periods);
  }

  void choose_period(const std::vector<SummaryPeriods>& periods) {
    std::vector<std::string> known;
    for (const SummaryPeriods& p : periods) {
      known.push_back(std::to_string(p.period_s));
      const std::int64_t from_us = std::max(r_.from_us, p.first_us);
      const std::int64_t to_us = std::min(r_.to_us, p.last_us + kSecond_us * p.period_s);
      const auto rows = static_cast<std::size_t>(
          std::max<std::int64_t>(0, (to_us - from_us) / (kSecond_us * p.period_s)));
      const bool fits = !a_.out.empty() || rows <= kScreenRows;
      if (a_.period_s == 0 && (r_.period_s == 0 || !period_fits_)) {
        r_.period_s = p.period_s;
        period_fits_ = fits;
      }
      if (a_.period_s == p.period_s) r_.period_s = p.period_s;
    }
    if (a_.period_s != 0 && r_.period_s == 0) {
      std::string all;
      for (const std::string& s : known) all += (all.empty() ? "" : ", ") + s;
      problem(fmt::format("--period: no summaries of {} s; there are {} s", a_.period_s,
                          all.empty() ? "none" : all));
    }
  }

  void choose_parameters() {
    const std::vector<SummaryParameter> all = summaries_.parameters();
    std::vector<std::string> names;
    for (const SummaryParameter& p : all) {
      names.push_back(p.name);
      if (is_chosen(a_.parameters, p.name)) r_.parameters.push_back(p);
    }
    check_patterns("--parameter", a_.parameters, names, problems_);
  }

  const HistoryArguments& a_;
  SummaryQuery& summaries_;
  std::vector<std::string>& problems_;
  HistoryRequest r_;
  bool period_fits_ = false;
};

}  // namespace

std::optional<std::int64_t> read_duration(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  const std::string unit(rest, end);
  const double seconds = unit.empty() || unit == "s" ? 1
                         : unit == "m"               ? 60
                         : unit == "h"               ? 3600
                         : unit == "d"               ? 86400
                                                     : 0;
  if (error != std::errc() || seconds == 0 || !(value > 0) || value * seconds > 1e10)
    return std::nullopt;
  return std::llround(1e6 * value * seconds);
}

bool is_chosen(const std::vector<std::string>& patterns, const std::string& name) {
  return patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const auto& p) {
           return ::fnmatch(p.c_str(), name.c_str(), 0) == 0;
         });
}

void check_patterns(const char* option, const std::vector<std::string>& patterns,
                    const std::vector<std::string>& names, std::vector<std::string>& problems) {
  for (const std::string& pattern : patterns) {
    if (std::any_of(names.begin(), names.end(),
                    [&](const auto& name) { return is_chosen({pattern}, name); }))
      continue;
    const std::string meant = nearest(pattern, names);
    problems.push_back(fmt::format("{}: there is no {}{}", option, pattern,
                                   meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
  }
}

std::optional<HistoryRequest> read_history_request(const HistoryArguments& arguments,
                                                   SummaryQuery& summaries,
                                                   std::vector<std::string>& problems) {
  HistoryRequest request = RequestReader(arguments, summaries, problems).read();
  if (!problems.empty()) return std::nullopt;
  return request;
}

}  // namespace framewatch::daemon
