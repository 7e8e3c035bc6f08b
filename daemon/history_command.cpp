#include "daemon/history_command.h"

#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include <fmt/core.h>

#include "daemon/config.h"
#include "daemon/config_suggest.h"
#include "daemon/history_files.h"
#include "daemon/history_overview.h"
#include "daemon/raw_export.h"
#include "daemon/raw_history_reader.h"
#include "daemon/simulation_output.h"
#include "daemon/summary_export.h"
#include "daemon/summary_query.h"
#include "drivers/count_block.h"

namespace framewatch::daemon {
namespace {

constexpr int kBadInput = 2;
constexpr std::int64_t kEver_us = INT64_MAX / 4, kSecond_us = 1'000'000;
constexpr std::size_t kScreenRows = 30;
constexpr std::int64_t kMostEvents = 1'000'000;

/// "90m", "2h", "3d", "45s" or "45" in microseconds.
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

bool chosen(const std::vector<std::string>& patterns, const std::string& name) {
  return patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const auto& p) {
           return ::fnmatch(p.c_str(), name.c_str(), 0) == 0;
         });
}

/// One run of the command.
class HistoryCommand {
 public:
  explicit HistoryCommand(const HistoryArguments& arguments) : a_(arguments) {}

  int run() {
    find_directory();
    check_names();
    if (!directory_.empty()) {
      if (const std::string why = summaries_.open(directory_); !why.empty())
        problem(fmt::format("{}: {}", summary_file(directory_), why));
      else
        read_request();
    }
    if (!problems_.empty()) return fail();
    const bool asks = !a_.out.empty() || !a_.raw.empty() || a_.events || !a_.parameters.empty() ||
                      a_.period_s != 0 || !a_.from.empty() || !a_.to.empty() || !a_.last.empty();
    if (!asks)
      fmt::print("{}", a_.json ? history_json(directory_, summaries_)
                               : history_overview(directory_, summaries_));
    if (a_.events) print_events();
    if (!a_.raw.empty()) export_raw();
    if (asks && problems_.empty() && !a_.events && (a_.raw.empty() || !a_.out.empty()))
      give_summaries();
    if (const std::string why = summaries_.problem(); !why.empty())
      problem(fmt::format("{}: {}", summary_file(directory_), why));
    return problems_.empty() ? 0 : fail();
  }

 private:
  void problem(std::string message) { problems_.push_back(std::move(message)); }
  int fail() const {
    for (const std::string& message : problems_) fmt::print(stderr, "{}\n", message);
    return kBadInput;
  }

  void find_directory() {
    std::error_code none;
    if (std::filesystem::is_directory(a_.place, none)) {
      directory_ = a_.place;
      return;
    }
    std::vector<ConfigProblem> found;
    config_ = load_config(a_.place, found);
    for (const ConfigProblem& p : found) problem(fmt::format("{}: {}", p.where, p.message));
    if (config_ && !config_->history)
      problem(a_.place + ": has no [history]: nothing is kept; docs/history.md says how");
    if (config_ && config_->history) directory_ = config_->history->directory;
  }

  void check_names() {
    if (!a_.out.empty() && !a_.out.ends_with(".csv") && !a_.out.ends_with(".csv.gz") &&
        !a_.out.ends_with(".mat"))
      problem(a_.out + ": the name for summaries must end in .csv, .csv.gz or .mat");
    if (!a_.raw.empty())
      if (const std::string rule = problem_of_raw_name(a_.raw); !rule.empty()) problem(rule);
    const auto code = [&](const char* option, const std::string& text, std::size_t most) {
      const bool good = !text.empty() && text.size() <= most &&
                        std::all_of(text.begin(), text.end(), [](unsigned char c) {
                          return std::isdigit(c) != 0 || (c >= 'A' && c <= 'Z');
                        });
      if (!good)
        problem(fmt::format("{}: {} capital letters and digits at most, got \"{}\"", option, most,
                            text));
    };
    code("--network", a_.network, 2);
    code("--station", a_.station, 5);
  }

  void read_request() {
    read_span();
    choose_parameters();
  }

  void read_span() {
    const std::vector<SummaryPeriods> periods = summaries_.periods();
    std::int64_t newest_us = summaries_.newest_us().value_or(INT64_MIN);
    for (const RawLog& log : raw_logs(raw_folder(directory_)))
      newest_us = std::max(newest_us, log.start_us + kSecond_us);
    const auto time = [&](const char* option, const std::string& text, std::int64_t& out) {
      if (text.empty()) return;
      if (const auto read = read_utc(text))
        out = *read;
      else
        problem(fmt::format("{}: \"{}\" is no time such as 2026-11-21T23:15:00Z", option, text));
    };
    time("--from", a_.from, from_us_);
    time("--to", a_.to, to_us_);
    if (!a_.last.empty()) {
      const auto duration = read_duration(a_.last);
      if (!a_.from.empty() || !a_.to.empty())
        problem("--last goes without --from and --to");
      else if (!duration)
        problem(fmt::format("--last: \"{}\" is no duration such as 90m, 2h or 3d", a_.last));
      else if (newest_us != INT64_MIN)
        from_us_ = newest_us - *duration;
    }
    if (from_us_ >= to_us_) problem("--from must be before --to");
    choose_period(periods);
  }

  void choose_period(const std::vector<SummaryPeriods>& periods) {
    std::vector<std::string> known;
    for (const SummaryPeriods& p : periods) {
      known.push_back(std::to_string(p.period_s));
      const std::int64_t from_us = std::max(from_us_, p.first_us);
      const std::int64_t to_us = std::min(to_us_, p.last_us + kSecond_us * p.period_s);
      const auto rows = static_cast<std::size_t>(
          std::max<std::int64_t>(0, (to_us - from_us) / (kSecond_us * p.period_s)));
      const bool fits = !a_.out.empty() || rows <= kScreenRows;
      if (a_.period_s == 0 && (period_s_ == 0 || !period_fits_)) {
        period_s_ = p.period_s;
        period_fits_ = fits;
      }
      if (a_.period_s == p.period_s) period_s_ = p.period_s;
    }
    if (a_.period_s != 0 && period_s_ == 0) {
      std::string all;
      for (const std::string& s : known) all += (all.empty() ? "" : ", ") + s;
      problem(fmt::format("--period: there are none of {} s; there are {} s", a_.period_s,
                          all.empty() ? "none" : all));
    }
  }

  void choose_parameters() {
    const std::vector<SummaryParameter> all = summaries_.parameters();
    std::vector<std::string> names;
    for (const SummaryParameter& p : all) {
      names.push_back(p.name);
      if (chosen(a_.parameters, p.name)) parameters_.push_back(p);
    }
    for (const std::string& pattern : a_.parameters) {
      if (std::any_of(names.begin(), names.end(),
                      [&](const auto& name) { return chosen({pattern}, name); }))
        continue;
      const std::string meant = nearest(pattern, names);
      problem(fmt::format("--parameter: there is no {}{}", pattern,
                          meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
    }
  }

  void print_events() {
    for (const event_t& e : summaries_.events(from_us_, to_us_, kMostEvents))
      fmt::print("{}\n", event_line(e));
  }

  void give_summaries() {
    std::vector<NamedSummaries> found;
    for (const SummaryParameter& p : parameters_)
      found.push_back({p, summaries_.rows(p.id, period_s_, from_us_, to_us_)});
    if (!a_.out.empty()) {
      if (const std::string why = write_summaries(a_.out, period_s_, found); !why.empty())
        problem(why);
      return;
    }
    fmt::print("{:<21} {:<12} {:>11} {:>11} {:>11} {:>11} {:>10}  {}\n",
               fmt::format("{} s from", period_s_), "parameter", "q1", "median", "q3", "std. error",
               "observable", "unit");
    for (const NamedSummaries& s : found)
      for (const SummaryRow& r : s.rows) {
        const auto value = [](double v) {
          return std::isfinite(v) ? fmt::format("{:.5g}", v) : "-";
        };
        fmt::print("{:<21} {:<12} {:>11} {:>11} {:>11} {:>11} {:>9.1f}%  {}\n",
                   utc_text(r.start_us), s.parameter.name, value(r.q1), value(r.median),
                   value(r.q3), value(r.std_error),
                   100.0 * static_cast<double>(r.observable) / static_cast<double>(r.windows),
                   s.parameter.unit);
      }
  }

  /// Where the channel of a name travels: where the configuration says, else on a node of its own.
  RawChannel placed(const std::string& name, std::size_t index) const {
    if (config_) {
      const auto all = addresses(config_->sources);
      for (std::size_t i = 0; i < all.size(); ++i)
        if (config_->pipeline.axes[i].name == name) return {name, all[i]};
    }
    return {name, {"ACCEL", static_cast<std::int32_t>(index), 0}};
  }

  void export_raw() {
    const std::vector<RawLog> logs = raw_logs_between(directory_, from_us_, to_us_);
    // What is in them first: an export has all of its channels from the start.
    std::vector<std::string> names;
    double rate_hz = 0, resolution_mps2 = 0;
    std::int64_t samples = 0;
    std::vector<std::string> notes;
    std::string why;
    const auto fails = [&] {
      problem(why);
      return;
    };
    if (!read_raw_history(logs, from_us_, to_us_,
                          {[&](const auto& now, double rate) {
                             for (const std::string& name : now)
                               if (std::find(names.begin(), names.end(), name) == names.end())
                                 names.push_back(name);
                             if (rate_hz == 0) rate_hz = rate;
                           },
                           [&](const RawCount& c) {
                             ++samples;
                             if (resolution_mps2 == 0) resolution_mps2 = c.resolution_mps2;
                           }},
                          notes, why))
      return fails();
    check_channels(names);
    if (samples == 0) problem("there are no raw samples in that time");
    if (!problems_.empty()) return;
    std::erase_if(names, [&](const std::string& name) { return !chosen(a_.channels, name); });
    std::vector<RawChannel> channels;
    for (const std::string& name : names) channels.push_back(placed(name, channels.size()));
    const auto out =
        raw_export(a_.raw, channels, rate_hz, resolution_mps2, {a_.network, a_.station}, why);
    if (!out) return fails();
    write_raw(logs, names, *out);
  }

  void check_channels(const std::vector<std::string>& names) {
    for (const std::string& pattern : a_.channels)
      if (std::none_of(names.begin(), names.end(),
                       [&](const auto& name) { return chosen({pattern}, name); })) {
        const std::string meant = nearest(pattern, names);
        problem(fmt::format("--channel: there is no {}{}", pattern,
                            meant.empty() ? "" : fmt::format("; did you mean {}?", meant)));
      }
  }

  void write_raw(const std::vector<RawLog>& logs, const std::vector<std::string>& names,
                 RawExport& out) {
    std::vector<std::optional<std::size_t>> place;  // by the log's channel
    std::int64_t samples = 0, beyond = 0;
    bool good = true;
    std::vector<std::string> notes;
    std::string why;
    const RawVisitor visitor{
        [&](const std::vector<std::string>& now, double) {
          place.assign(now.size(), std::nullopt);
          for (std::size_t i = 0; i < now.size(); ++i)
            if (const auto at = std::find(names.begin(), names.end(), now[i]); at != names.end())
              place[i] = static_cast<std::size_t>(at - names.begin());
        },
        [&](const RawCount& c) {
          if (!good || !place[c.channel]) return;
          ++samples;
          beyond += c.count == drivers::kMostCount || c.count == -drivers::kMostCount;
          const double accel = c.count == drivers::kNoCount
                                   ? std::numeric_limits<double>::quiet_NaN()
                                   : c.count * c.resolution_mps2;
          good = out.put(*place[c.channel], c.time_us, accel);
        }};
    const bool read = read_raw_history(logs, from_us_, to_us_, visitor, notes, why);
    if (!read || !good || !out.close()) {
      problem(read ? fmt::format("{}: {}", a_.raw, out.error()) : why);
      return;
    }
    fmt::print("{}: {} samples of {} channels\n", a_.raw, samples, names.size());
    if (beyond > 0) fmt::print("{} of them are beyond what was stored\n", beyond);
    for (const std::string& note : notes) fmt::print("{}\n", note);
    for (const std::string& note : out.notes()) fmt::print("{}\n", note);
  }

  const HistoryArguments& a_;
  std::vector<std::string> problems_;
  std::optional<Config> config_;
  std::string directory_;
  SummaryQuery summaries_;
  std::int64_t from_us_ = -kEver_us, to_us_ = kEver_us, period_s_ = 0;
  bool period_fits_ = false;
  std::vector<SummaryParameter> parameters_;
};

}  // namespace

int history(const HistoryArguments& arguments) {
  return HistoryCommand(arguments).run();
}

}  // namespace framewatch::daemon
