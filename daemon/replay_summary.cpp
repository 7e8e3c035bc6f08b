#include "daemon/replay_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

struct Counts {
  std::int64_t windows, gaps, lost, late, repaired, rejected, malformed, foreign;
  std::int64_t stuck = 0, clipped = 0;
};

Counts count(const Estimation& estimation) {
  const PipelineCounters pipeline = estimation.pipeline().counters();
  const drivers::IntakeCounters& intake = estimation.intake().counters();
  Counts c{pipeline.windows, pipeline.gaps, estimation.intake().lost(), 0, 0, intake.duplicate,
           intake.malformed, intake.foreign};
  for (const AxisCounters& axis : pipeline.axes) {
    c.late += axis.late;
    c.repaired += axis.repaired;
    c.rejected += axis.rejected;
    c.stuck += axis.stuck;
    c.clipped += axis.clipped;
  }
  return c;
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<int>(c));
    else
      out += c;
  }
  return out + '"';
}

}  // namespace

ReplaySummary::ReplaySummary(const ParameterTable& table)
    : values_(static_cast<std::size_t>(table.size())) {
  for (int i = 0; i < table.size(); ++i) {
    names_.push_back(table[i].name);
    units_.push_back(table[i].unit);
  }
}

void ReplaySummary::add(const WindowEstimate& estimate) {
  ++windows_;
  for (std::size_t i = 0; i < values_.size(); ++i)
    if (estimate.reason[i] == Observability::observable) values_[i].push_back(estimate.value[i]);
}

ReplaySummary::Quartiles ReplaySummary::quartiles(std::size_t parameter) const {
  const std::vector<double>& values = values_[parameter];
  if (values.empty()) return {NAN, NAN, NAN, 0};
  // Only what the quartiles need is put in order.
  std::vector<double> ordered = values;
  auto from = ordered.begin();
  const auto at = [&](double probability) {
    const double position = std::clamp(probability * static_cast<double>(ordered.size()) - 0.5, 0.0,
                                       static_cast<double>(ordered.size() - 1));
    const auto below = ordered.begin() + static_cast<std::ptrdiff_t>(position);
    std::nth_element(from, below, ordered.end());
    const auto above =
        below + 1 == ordered.end() ? below : std::min_element(below + 1, ordered.end());
    const double part = position - std::floor(position);
    const double value = *below + part * (*above - *below);
    from = below;
    return value;
  };
  const double q1 = at(0.25), q2 = at(0.5), q3 = at(0.75);
  return {q1, q2, q3, static_cast<double>(values.size()) / static_cast<double>(windows_)};
}

std::string ReplaySummary::text(const Estimation& estimation, const ReplaySurvey& survey,
                                double work_s) const {
  const Counts c = count(estimation);
  std::string out = fmt::format(
      "{:.2f} s of motion in {:.2f} s ({:.0f} times real time)\n"
      "windows {}, gaps {}, lost messages {}, late {}, repaired {}, rejected {}, stuck {}, clipped "
      "{}\n"
      "undecodable messages {}, foreign {}, damaged bytes {}\n\n"
      "{:<14} {:>12} {:>12} {:>12}  {:<11} {:>10}\n",
      survey.measured_seconds(), work_s, survey.measured_seconds() / work_s, c.windows, c.gaps,
      c.lost, c.late, c.repaired, c.rejected, c.stuck, c.clipped, c.malformed, c.foreign,
      survey.damaged_bytes(), "parameter", "q1", "median", "q3", "unit", "observable");
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Quartiles q = quartiles(i);
    if (values_[i].empty())
      out += fmt::format("{:<14} {:>12} {:>12} {:>12}  {:<11} {:>9.1f} %\n", names_[i], "-", "-",
                         "-", units_[i], 0.0);
    else
      out += fmt::format("{:<14} {:>12.6g} {:>12.6g} {:>12.6g}  {:<11} {:>9.1f} %\n", names_[i],
                         q.q1, q.median, q.q3, units_[i], 100 * q.observable_ratio);
  }
  return out;
}

std::string ReplaySummary::json(const Estimation& estimation, const ReplaySurvey& survey,
                                double work_s) const {
  const Counts c = count(estimation);
  std::string out = fmt::format(
      "{{\"schema\": \"framewatch.replay/1\", \"motion_s\": {}, \"work_s\": {}, \"windows\": {}, "
      "\"gaps\": {}, \"lost\": {}, \"late\": {}, \"repaired\": {}, \"rejected\": {}, "
      "\"stuck\": {}, \"clipped\": {}, "
      "\"malformed\": {}, \"foreign\": {}, \"damaged_bytes\": {},\n \"notes\": [",
      number(survey.measured_seconds()), number(work_s), c.windows, c.gaps, c.lost, c.late,
      c.repaired, c.rejected, c.stuck, c.clipped, c.malformed, c.foreign, survey.damaged_bytes());
  for (std::size_t i = 0; i < survey.notes().size(); ++i)
    out += (i == 0 ? "" : ", ") + quoted(survey.notes()[i]);
  out += "],\n \"parameters\": [";
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const Quartiles q = quartiles(i);
    out += fmt::format(
        "{}\n  {{\"name\": {}, \"unit\": {}, \"q1\": {}, \"median\": {}, \"q3\": {}, "
        "\"observable_ratio\": {}}}",
        i == 0 ? "" : ",", quoted(names_[i]), quoted(units_[i]), number(q.q1), number(q.median),
        number(q.q3), number(q.observable_ratio));
  }
  return out + "]}\n";
}

}  // namespace framewatch::daemon
