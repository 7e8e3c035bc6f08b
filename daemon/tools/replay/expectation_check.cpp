#include "daemon/tools/replay/expectation_check.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

using Series = EstimateSeries::Series;
using Range = EstimateSeries::Range;

double seconds(std::int64_t time_us, std::int64_t first_us) {
  return static_cast<double>(time_us - first_us) / 1e6;
}

std::int64_t microseconds(double time_s, std::int64_t first_us) {
  return time_s < 4e9 ? first_us + std::llround(time_s * 1e6) : INT64_MAX;
}

/// The tolerance as the file gives it.
std::string rule_of(const Tolerance& t) {
  if (t.absolute) return fmt::format("{:g}", *t.absolute);
  if (t.ratio) return fmt::format("{:g} %", 100 * *t.ratio);
  return fmt::format("{:g} standard errors", t.std_errors.value_or(0));
}

class Checker {
 public:
  explicit Checker(const ReplayOutcome& found) : found_(found) {}

  void counts(const CountExpectation& e) {
    const auto at = std::find_if(found_.counts.begin(), found_.counts.end(),
                                 [&](const auto& count) { return count.first == e.name; });
    const auto n = at->second;
    Check c;
    c.subject = e.name;
    c.quantity = e.most == INT64_MAX ? "at least" : "count";
    c.expected = static_cast<double>(e.least);
    c.found = static_cast<double>(n);
    c.holds = n >= e.least && n <= e.most;
    out.push_back(c);
  }

  void events(const EventExpectation& e) {
    const auto fits = [&](const RaisedEvent& event) {
      const double since_s = seconds(event.since_us, found_.first_us);
      return (e.kind.empty() || event.kind == e.kind) &&
             (e.place.empty() || event.place == e.place) && since_s >= e.span.from_s &&
             since_s <= e.span.to_s;
    };
    Check c;
    c.subject = "event " + (e.kind.empty() ? std::string("of any kind") : e.kind);
    if (!e.place.empty()) c.subject += " at " + e.place;
    c.quantity = "count";
    if (e.span.to_s < 4e9)
      c.quantity += fmt::format(" from {:g} s to {:g} s", e.span.from_s, e.span.to_s);
    c.expected = static_cast<double>(e.count);
    c.found = static_cast<double>(std::count_if(found_.events.begin(), found_.events.end(), fits));
    c.holds = c.found == c.expected;
    for (const RaisedEvent& event : found_.events) {
      if (c.holds || event.kind != e.kind || c.first_s) continue;
      c.first_s = seconds(event.since_us, found_.first_us);
      c.farthest_s = c.first_s;
    }
    out.push_back(c);
  }

  void parameter(const ParameterExpectation& e, const Series& series) {
    const Range range = found_.series.range(
        microseconds(e.span.from_s, found_.first_us),
        e.span.to_s < 4e9 ? microseconds(e.span.to_s, found_.first_us) : INT64_MAX);
    const EstimateSeries::Quartiles q = found_.series.quartiles(series, range);
    if (e.median) quartile(e, series, range, "median", *e.median, q.median);
    if (e.q1) quartile(e, series, range, "q1", *e.q1, q.q1);
    if (e.q3) quartile(e, series, range, "q3", *e.q3, q.q3);
    if (e.value) value(e, series, range);
    const double share = std::isnan(q.observable_ratio) ? 0 : q.observable_ratio;
    if (e.observable_ratio)
      observable(series, range, "observable share", *e.observable_ratio, share,
                 std::abs(share - *e.observable_ratio) <= e.observable_tolerance + 1e-12,
                 share < *e.observable_ratio, e.observable_tolerance);
    if (e.observable_min_ratio)
      observable(series, range, "observable share at least", *e.observable_min_ratio, share,
                 share >= *e.observable_min_ratio, true, 0);
    if (e.observable_max_ratio)
      observable(series, range, "observable share at most", *e.observable_max_ratio, share,
                 share <= *e.observable_max_ratio, false, 0);
  }

  std::vector<Check> out;

 private:
  double end_s(std::size_t window) const {
    return seconds(found_.series.end_us()[window], found_.first_us);
  }

  static Check start(const Series& series, const char* quantity, double expected) {
    Check c;
    c.subject = series.name;
    c.quantity = quantity;
    c.unit = series.unit;
    c.expected = expected;
    return c;
  }

  /// First and farthest window outside.
  void locate(Check& c, const Series& series, Range range,
              const std::function<double(std::size_t)>& allowed) const {
    double most = 0;
    for (std::size_t w = range.begin; w < range.end; ++w) {
      const double distance = std::abs(series.value[w] - c.expected);
      if (!(distance > allowed(w))) continue;
      if (!c.first_s) c.first_s = end_s(w);
      if (distance <= most) continue;
      most = distance;
      c.farthest_s = end_s(w);
      c.farthest = series.value[w];
    }
  }

  void quartile(const ParameterExpectation& e, const Series& series, Range range,
                const char* quantity, double expected, double found) {
    Check c = start(series, quantity, expected);
    c.found = found;
    c.rule = rule_of(e.tolerance);
    c.allowed = allowed(e.tolerance, expected, [&] { return usual_error(series, range); });
    c.holds = std::abs(found - expected) <= c.allowed;
    if (!c.holds) locate(c, series, range, [&](std::size_t) { return c.allowed; });
    out.push_back(c);
  }

  void value(const ParameterExpectation& e, const Series& series, Range range) {
    Check c = start(series, "value", *e.value);
    c.rule = rule_of(e.tolerance);
    const auto allowed_at = [&](std::size_t w) {
      return allowed(e.tolerance, *e.value, [&] { return double{series.std_error[w]}; });
    };
    locate(c, series, range, allowed_at);
    const auto first = series.value.begin() + std::ptrdiff_t(range.begin);
    const auto last = series.value.begin() + std::ptrdiff_t(range.end);
    const bool any = std::any_of(first, last, [](double v) { return !std::isnan(v); });
    c.holds = any && !c.farthest_s;
    c.allowed = allowed(e.tolerance, *e.value, [&] { return usual_error(series, range); });
    c.found = !any ? NAN : c.farthest_s ? c.farthest : *e.value;
    out.push_back(c);
  }

  void observable(const Series& series, Range range, const char* quantity, double expected,
                  double found, bool holds, bool too_few, double tolerance) {
    Check c = start(series, quantity, expected);
    c.unit.clear();
    c.found = found;
    c.holds = holds;
    c.allowed = tolerance;
    c.rule = fmt::format("{:g}", tolerance);
    for (std::size_t w = range.begin; w < range.end && !holds && !c.first_s; ++w)
      if (std::isnan(series.value[w]) == too_few) c.first_s = c.farthest_s = end_s(w);
    out.push_back(c);
  }

  template <typename Error>
  static double allowed(const Tolerance& t, double expected, Error std_error) {
    if (t.absolute) return *t.absolute;
    if (t.ratio) return *t.ratio * std::abs(expected);
    return t.std_errors.value_or(0) * std_error();
  }

  static double usual_error(const Series& series, Range range) {
    return quartiles_of({series.std_error.begin() + std::ptrdiff_t(range.begin),
                         series.std_error.begin() + std::ptrdiff_t(range.end)})[1];
  }

  const ReplayOutcome& found_;
};

}  // namespace

double Check::distance() const {
  return std::abs(found - expected);
}

std::string Check::text() const {
  const std::string of = unit.empty() ? "" : " " + unit;
  std::string out = fmt::format("{} {}: expected {:.7g}{}", subject, quantity, expected, of);
  if (allowed > 0) out += fmt::format(" within {:.4g} ({})", allowed, rule);
  if (std::isnan(found)) return out + ", found no value";
  out += fmt::format(", found {:.7g}: {:.4g} off", found, distance());
  if (expected != 0 && !unit.empty())
    out += fmt::format(" ({:+.2f} %)", 100 * (found / expected - 1));
  if (!first_s) return out;
  if (unit.empty()) return out + fmt::format("; first at {:.3f} s", *first_s);
  return out + fmt::format("; outside from {:.3f} s on, farthest at {:.3f} s ({:.7g})", *first_s,
                           *farthest_s, farthest);
}

std::vector<Check> check_expectations(const Expectations& expectations,
                                      const ReplayOutcome& found) {
  Checker checker(found);
  for (const CountExpectation& e : expectations.counts) checker.counts(e);
  for (const ParameterExpectation& e : expectations.parameters)
    for (const int p : e.parameters)
      checker.parameter(e, found.series.parameters()[static_cast<std::size_t>(p)]);
  for (const EventExpectation& e : expectations.events) checker.events(e);
  return std::move(checker.out);
}

}  // namespace framewatch::daemon
