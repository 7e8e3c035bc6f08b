// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/expectation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/base/toml_document.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/config/sections/config_problems.h"

namespace framewatch::daemon {
namespace {

std::optional<double> number(const ConfigSection& s, std::string_view key) {
  if (!s.given(key)) return std::nullopt;
  return s.number(key);
}

ExpectedSpan span_of(ConfigSection& s) {
  ExpectedSpan span;
  if (s.given("from_s")) span.from_s = s.number("from_s");
  if (s.given("to_s")) span.to_s = s.number("to_s");
  if (s.given("to_s") && !(span.to_s > span.from_s))
    s.problem("to_s", fmt::format("must be later than from_s ({:g})", span.from_s));
  return span;
}

class ExpectationReader {
 public:
  ExpectationReader(const estimator::ParameterTable& table, std::vector<TextProblem>& problems)
      : table_(table), problems_(problems) {}

  Expectations read(const TomlValue& document) {
    Expectations out;
    ConfigSection top("expect", "expectations", &document, {}, problems_);
    out.reason = top.text("reason");
    if (top.given("reason") && out.reason.find_first_not_of(" \t") == std::string::npos)
      top.problem("reason", "is empty: say why these numbers are right");
    if (const TomlEntry* counts = document.find("counts")) read_counts(counts->value, out);
    for (const TomlValue* value : tables_of(document, "parameter", problems_))
      read_parameter(*value, out);
    for (const TomlValue* value : tables_of(document, "event", problems_)) read_event(*value, out);
    if (problems_.empty() && out.counts.empty() && out.parameters.empty() && out.events.empty())
      problems_.push_back({{}, "expects nothing: no [counts], no [[parameter]], no [[event]]"});
    return out;
  }

 private:
  void read_counts(const TomlValue& value, Expectations& out) {
    ConfigSection s("expect.counts", "counts", &value, {}, problems_);
    if (value.kind != TomlKind::table) return;
    for (const TomlEntry& entry : value.entries) {
      if (!s.given(entry.key)) continue;
      const std::int64_t n = entry.value.integer;
      if (entry.key == "windows_min")
        out.counts.push_back({"windows", n, INT64_MAX});
      else
        out.counts.push_back({entry.key, n, n});
    }
  }

  void read_parameter(const TomlValue& value, Expectations& out) {
    ConfigSection s("expect.parameter", "parameter", &value, {}, problems_);
    ParameterExpectation e;
    e.parameters = members(s);
    e.median = number(s, "median");
    e.q1 = number(s, "q1");
    e.q3 = number(s, "q3");
    e.value = number(s, "value");
    e.tolerance = {number(s, "tolerance"), number(s, "tolerance_ratio"),
                   number(s, "tolerance_std_errors")};
    e.observable_ratio = number(s, "observable_ratio");
    e.observable_tolerance = s.number("observable_tolerance");
    e.observable_min_ratio = number(s, "observable_min_ratio");
    e.observable_max_ratio = number(s, "observable_max_ratio");
    e.span = span_of(s);
    const bool numbers = e.median || e.q1 || e.q3 || e.value;
    const int tolerances = static_cast<int>(e.tolerance.absolute.has_value()) +
                           static_cast<int>(e.tolerance.ratio.has_value()) +
                           static_cast<int>(e.tolerance.std_errors.has_value());
    if (tolerances > 1 || (numbers && tolerances == 0))
      s.problem(tolerances > 1 && e.tolerance.ratio ? "tolerance_ratio" : "tolerance",
                "one of tolerance, tolerance_ratio, tolerance_std_errors must be given with "
                "median, q1, q3 or value");
    if (!numbers && !e.observable_ratio && !e.observable_min_ratio && !e.observable_max_ratio)
      s.problem("median", "expects nothing: give median, q1, q3, value or an observable ratio");
    out.parameters.push_back(std::move(e));
  }

  std::vector<int> members(ConfigSection& s) {
    std::vector<int> found;
    if (s.given("name") == s.given("group")) {
      if (s.good("name") && s.good("group"))
        s.problem("name", "one of name and group must be given");
      return found;
    }
    if (s.given("name")) {
      if (const auto index = table_.find(s.text("name"))) return {*index};
      std::vector<std::string> names;
      for (int i = 0; i < table_.size(); ++i) names.push_back(table_[i].name);
      const std::string meant = nearest(s.text("name"), names);
      s.problem("name", fmt::format("this building has no parameter \"{}\"{}", s.text("name"),
                                    meant.empty() ? "; `framewatch check` lists them"
                                                  : fmt::format(", did you mean \"{}\"?", meant)));
      return found;
    }
    constexpr std::array<std::pair<std::string_view, estimator::ParameterKind>, 4> kKinds{{
        {"frame_stiffness", estimator::ParameterKind::frame_stiffness},
        {"panel_stiffness", estimator::ParameterKind::panel_stiffness},
        {"frame_damping", estimator::ParameterKind::frame_damping},
        {"panel_damping", estimator::ParameterKind::panel_damping},
    }};
    const std::string group = s.text("group");
    for (int i = 0; i < table_.size(); ++i)
      for (const auto& [name, kind] : kKinds)
        if (table_[i].kind == kind && (group == "all" || group == name)) found.push_back(i);
    if (found.empty()) s.problem("group", "this building has no parameter of that group");
    return found;
  }

  void read_event(const TomlValue& value, Expectations& out) {
    ConfigSection s("expect.event", "event", &value, {}, problems_);
    EventExpectation e;
    if (s.given("kind")) e.kind = s.text("kind");
    if (s.given("place")) e.place = s.text("place");
    e.count = s.integer("count");
    e.span = span_of(s);
    out.events.push_back(std::move(e));
  }

  const estimator::ParameterTable& table_;
  std::vector<TextProblem>& problems_;
};

using Series = EstimateSeries::Series;
using Range = EstimateSeries::Range;

double seconds(std::int64_t time_us, std::int64_t first_us) {
  return static_cast<double>(time_us - first_us) / 1e6;
}

std::int64_t microseconds(double time_s, std::int64_t first_us) {
  return time_s < 4e9 ? first_us + std::llround(time_s * 1e6) : INT64_MAX;
}

/// Returns the tolerance as the file gives it.
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
    const Range range = found_.series.range(microseconds(e.span.from_s, found_.first_us),
                                            microseconds(e.span.to_s, found_.first_us));
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

  /// Sets the first and the farthest window outside the tolerance.
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

constexpr double kStiffnessTolerance = 0.01;
constexpr double kDampingTolerance = 0.05;
constexpr double kObservableTolerance = 0.01;

bool is_damping(estimator::ParameterKind kind) {
  return kind == estimator::ParameterKind::frame_damping ||
         kind == estimator::ParameterKind::panel_damping;
}

/// Returns `text` escaped for XML, without control characters, which XML forbids.
std::string escaped(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return html_text(text);
}

}  // namespace

std::optional<Expectations> load_expectations(const std::string& path,
                                              const estimator::ParameterTable& table,
                                              std::vector<ConfigProblem>& problems) {
  Expectations expectations;
  const bool good = read_toml_file(
      path,
      [&](const TomlValue& document, std::vector<TextProblem>& found) {
        expectations = ExpectationReader(table, found).read(document);
      },
      problems);
  if (!good) return std::nullopt;
  expectations.path = path;
  return expectations;
}

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

std::string written_expectations(const ReplayOutcome& found, const std::string& command) {
  std::string out = fmt::format(
      "# Expected results of a replay: framewatch replay ... --expect THIS_FILE\n"
      "# First written by: {}\n"
      "# Keys and units: docs/configuration.md, expectation files. Tolerances are proposals.\n"
      "reason = \"\"  # fill in: why are these numbers right?\n\n[counts]\n",
      command);
  for (const auto& [name, count] : found.counts)
    if (name != std::string("foreign")) out += fmt::format("{} = {}\n", name, count);
  for (const EstimateSeries::Series& series : found.series.parameters()) {
    const EstimateSeries::Quartiles q = found.series.quartiles(series, found.series.all());
    out += fmt::format("\n[[parameter]]\nname = \"{}\"  # {}\n", series.name, series.unit);
    if (!std::isnan(q.median)) {
      out += fmt::format("median = {:.7g}\nq1 = {:.7g}\nq3 = {:.7g}\n", q.median, q.q1, q.q3);
      out += fmt::format("tolerance_ratio = {:g}\n",
                         is_damping(series.kind) ? kDampingTolerance : kStiffnessTolerance);
    }
    out +=
        fmt::format("observable_ratio = {:.4f}\nobservable_tolerance = {:g}\n",
                    std::isnan(q.observable_ratio) ? 0 : q.observable_ratio, kObservableTolerance);
  }
  return out;
}

std::string junit_xml(const std::vector<Check>& checks, const std::string& suite) {
  std::size_t failures = 0;
  std::string cases;
  for (const Check& c : checks) {
    cases +=
        fmt::format("  <testcase classname=\"{}\" name=\"{}\"", escaped(suite), escaped(c.name()));
    if (c.holds) {
      cases += "/>\n";
      continue;
    }
    ++failures;
    cases += fmt::format(">\n    <failure message=\"{}\"/>\n  </testcase>\n", escaped(c.text()));
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\">\n{}</testsuite>\n",
      escaped(suite), checks.size(), failures, cases);
}

std::string differences_json(const std::vector<Check>& checks) {
  std::string out = "[";
  const char* comma = "";
  const auto time = [](const std::optional<double>& t) { return json_number(t.value_or(NAN)); };
  for (const Check& c : checks) {
    if (c.holds) continue;
    out += fmt::format(
        "{}\n  {{\"subject\": {}, \"quantity\": {}, \"unit\": {}, \"expected\": {}, \"found\": {}, "
        "\"off\": {}, \"allowed\": {}, \"first_s\": {}, \"farthest_s\": {}, \"text\": {}}}",
        comma, json_text(c.subject), json_text(c.quantity), json_text(c.unit),
        json_number(c.expected), json_number(c.found), json_number(c.distance()),
        json_number(c.allowed), time(c.first_s), time(c.farthest_s), json_text(c.text()));
    comma = ",";
  }
  return out + "]";
}

}  // namespace framewatch::daemon
