// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replay_summary.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/json.h"
#include "daemon/monitor/estimates/estimate_table.h"

namespace framewatch::daemon {
namespace {

/// Returns the two most frequent reasons why a parameter was not observable.
std::string reasons(const EstimateSeries::Series& series) {
  std::array<int, 6> order{1, 2, 3, 4, 5, kTooUncertain};
  const auto count = [&](int reason) { return series.reasons[static_cast<std::size_t>(reason)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return count(a) > count(b); });
  std::string text;
  for (const int reason : {order[0], order[1]})
    if (count(reason) > 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", reason_word(reason), count(reason));
  return text;
}

/// Returns the counts of the CAN nodes as text of several lines; empty without CAN.
std::string can_text(const drivers::CanIntake& can) {
  if (can.map().empty()) return {};
  std::string out;
  for (std::size_t b = 0; b < can.buses().size(); ++b) {
    const drivers::CanBusCounters& bus = can.buses()[b];
    out += fmt::format("{}: {} frames, {} of other devices, {} SYNC, {} error frames\n",
                       can.map().buses[b].interface, bus.frames, bus.foreign, bus.syncs,
                       bus.error_frames);
  }
  out +=
      fmt::format("{:<14} {:>9} {:>9} {:>7} {:>6} {:>6} {:>9} {:>7} {:>9}\n", "CAN node", "rate_Hz",
                  "received", "lost", "late", "twice", "reordered", "no time", "malformed");
  for (std::size_t n = 0; n < can.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters c = can.node(n);
    out += fmt::format("{:<14} {:>9.4f} {:>9} {:>7} {:>6} {:>6} {:>9} {:>7} {:>9}\n",
                       can.map().nodes[n].name, c.rate_hz(), c.received, c.lost, c.late,
                       c.duplicates, c.reordered, c.unplaced, c.wrong_length + c.wrong_kind);
    for (const drivers::CanMessageMap& m : can.map().nodes[n].messages)
      for (const drivers::CanReading& r : m.readings) {
        if (r.sample > 0) continue;
        const drivers::CanRange& range = can.range_of(static_cast<std::size_t>(r.axis));
        out += fmt::format("  {}.{}: {} values from {:g} to {:g}\n", m.name, r.name, range.count,
                           range.least, range.most);
      }
  }
  return out + "\n";
}

/// Returns the JSON members can_nodes and can_buses, each with a comma after it; empty without CAN.
std::string can_json(const drivers::CanIntake& can) {
  if (can.map().empty()) return {};
  std::string out = "\"can_nodes\": [";
  for (std::size_t n = 0; n < can.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters c = can.node(n);
    out += fmt::format(
        "{}\n  {{\"name\": {}, \"rate_hz\": {}, \"received\": {}, \"lost\": {}, \"late\": {}, "
        "\"duplicates\": {}, \"reordered\": {}, \"unplaced\": {}, \"malformed\": {}}}",
        n == 0 ? "" : ",", json_text(can.map().nodes[n].name), json_number(c.rate_hz()), c.received,
        c.lost, c.late, c.duplicates, c.reordered, c.unplaced, c.wrong_length + c.wrong_kind);
  }
  out += "],\n \"can_buses\": [";
  for (std::size_t b = 0; b < can.buses().size(); ++b) {
    const drivers::CanBusCounters& bus = can.buses()[b];
    out += fmt::format(
        "{}\n  {{\"interface\": {}, \"frames\": {}, \"foreign\": {}, \"syncs\": {}, "
        "\"error_frames\": {}}}",
        b == 0 ? "" : ",", json_text(can.map().buses[b].interface), bus.frames, bus.foreign,
        bus.syncs, bus.error_frames);
  }
  return out + "],\n ";
}

}  // namespace

ReplayCounts replay_counts(const Estimation& estimation) {
  const estimator::PipelineCounters pipeline = estimation.pipeline().counters();
  const drivers::IntakeCounters& intake = estimation.intake().counters();
  std::int64_t lost = estimation.intake().lost(), malformed = intake.malformed;
  std::int64_t foreign = intake.foreign;
  const drivers::CanIntake& can = estimation.can();
  for (std::size_t n = 0; n < can.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters node = can.node(n);
    lost += node.lost;
    malformed += node.wrong_length + node.wrong_kind;
  }
  for (const drivers::CanBusCounters& bus : can.buses()) foreign += bus.foreign;
  std::int64_t late = 0, repaired = 0, rejected = intake.duplicate + intake.other_sender;
  std::int64_t stuck = 0, clipped = 0;
  for (const estimator::AxisCounters& axis : estimation.axis_counters()) {
    late += axis.late;
    repaired += axis.repaired;
    rejected += axis.rejected;
    stuck += axis.stuck;
    clipped += axis.clipped;
  }
  return {{{"windows", pipeline.windows},
           {"gaps", pipeline.interruptions},
           {"lost", lost},
           {"late", late},
           {"repaired", repaired},
           {"rejected", rejected},
           {"stuck", stuck},
           {"clipped", clipped},
           {"malformed", malformed},
           {"foreign", foreign}}};
}

std::string why_no_window(const Config& config, const Estimation& estimation, double motion_s) {
  const estimator::EstimatorOptions& o = config.pipeline.options;
  if (motion_s < std::max(o.window_s, o.hop_s))
    return fmt::format(
        "no window: there are {:.4g} s of motion, too few samples to fill the estimator's filters. "
        "Give a record of at least {:g} s (estimator.window_s)",
        motion_s, std::max(o.window_s, o.hop_s));
  std::string silent;
  const auto counters = estimation.axis_counters();
  for (std::size_t i = 0; i < counters.size() && i < config.pipeline.axes.size(); ++i)
    if (counters[i].received == 0)
      silent += (silent.empty() ? "" : ", ") + config.pipeline.axes[i].name;
  if (!silent.empty()) return "no window: there is no sample of " + silent;
  return fmt::format(
      "no window: the channels have too few samples at the same times; {} interruptions restarted "
      "the estimation",
      estimation.pipeline().counters().interruptions);
}

std::string ReplaySummary::text() const {
  const auto count = [&](std::size_t i) { return counts[i].second; };
  std::string out = fmt::format(
      "{:.2f} s of motion in {:.2f} s ({:.0f} times real time)\n"
      "windows {}, gaps {}, lost messages {}, late {}, repaired {}, rejected {}, stuck {}, clipped "
      "{}\n"
      "undecodable messages {}, foreign {}, damaged bytes {}\n\n{}"
      "{:<14} {:>12} {:>12} {:>12}  {:<11} {:>10}  {}\n",
      survey.measured_seconds(), work_s, survey.measured_seconds() / work_s, count(0), count(1),
      count(2), count(3), count(4), count(5), count(6), count(7), count(8), count(9),
      survey.damaged_bytes(), can_text(can), "parameter", "q1", "median", "q3", "unit",
      "observable", "windows without");
  for (const EstimateSeries::Series& s : series.parameters()) {
    const EstimateSeries::Quartiles q = series.quartiles(s, series.all());
    const auto number = [](double v) { return std::isnan(v) ? "-" : fmt::format("{:.6g}", v); };
    const double percent = std::isnan(q.observable_ratio) ? 0 : 100 * q.observable_ratio;
    out += fmt::format("{:<14} {:>12} {:>12} {:>12}  {:<11} {:>8.1f} %  {}\n", s.name, number(q.q1),
                       number(q.median), number(q.q3), s.unit, percent, reasons(s));
  }
  return out;
}

std::string ReplaySummary::json() const {
  std::string out =
      fmt::format("{{\"schema\": \"framewatch.replay/1\", \"motion_s\": {}, \"work_s\": {}, ",
                  json_number(survey.measured_seconds()), json_number(work_s));
  for (const auto& [name, value] : counts) out += fmt::format("\"{}\": {}, ", name, value);
  out += fmt::format("\"damaged_bytes\": {},\n \"notes\": [", survey.damaged_bytes());
  for (std::size_t i = 0; i < survey.notes().size(); ++i)
    out += (i == 0 ? "" : ", ") + json_text(survey.notes()[i]);
  out += "],\n " + can_json(can) + "\"parameters\": [";
  const char* comma = "";
  for (const EstimateSeries::Series& s : series.parameters()) {
    const EstimateSeries::Quartiles q = series.quartiles(s, series.all());
    out += fmt::format(
        "{}\n  {{\"name\": {}, \"unit\": {}, \"q1\": {}, \"median\": {}, \"q3\": {}, "
        "\"observable_ratio\": {}, \"reasons\": {{",
        comma, json_text(s.name), json_text(s.unit), json_number(q.q1), json_number(q.median),
        json_number(q.q3), json_number(q.observable_ratio));
    for (std::size_t r = 0; r < s.reasons.size(); ++r)
      out += fmt::format("{}\"{}\": {}", r == 0 ? "" : ", ", reason_word(static_cast<int>(r)),
                         s.reasons[r]);
    out += "}}";
    comma = ",";
  }
  return out + "]";
}

}  // namespace framewatch::daemon
