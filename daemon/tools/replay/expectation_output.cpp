#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/tools/replay/expectation_check.h"

namespace framewatch::daemon {
namespace {

constexpr double kStiffnessTolerance = 0.01;
constexpr double kDampingTolerance = 0.05;
constexpr double kObservableTolerance = 0.01;

bool is_damping(estimator::ParameterKind kind) {
  return kind == estimator::ParameterKind::frame_damping ||
         kind == estimator::ParameterKind::panel_damping;
}

/// XML has no control characters.
std::string escaped(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
  return html_text(text);
}

}  // namespace

std::string written_expectations(const ReplayOutcome& found, const std::string& command) {
  std::string out = fmt::format(
      "# What this replay must give: framewatch replay ... --expect THIS_FILE\n"
      "# First written by: {}\n"
      "# Keys and units: docs/configuration.md, expectation files. Tolerances are proposals.\n"
      "reason = \"\"  # to fill in: why are these numbers right?\n\n[counts]\n",
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
