#include "daemon/tools/replay/expectation.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

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
      s.problem(
          tolerances > 1 && e.tolerance.ratio ? "tolerance_ratio" : "tolerance",
          "one of tolerance, tolerance_ratio, tolerance_std_errors must be given with median, "
          "q1, q3 or value");
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

}  // namespace framewatch::daemon
