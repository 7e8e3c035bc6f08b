#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {
namespace {

std::string number(double value, int digits = 4) {
  return std::isfinite(value) ? fmt::format("{:#.{}g}", value, digits) : "-";
}

std::string ratio_percent(double ratio, const char* format = "{:.1f}") {
  return std::isfinite(ratio) ? fmt::format(fmt::runtime(format), 100 * ratio) : "-";
}

/// Why a parameter had no value, the most frequent reason: "quiet".
std::string without(const SessionReport& r, std::size_t p, WindowRange windows) {
  std::array<std::size_t, kReasons> counts{};
  for (std::size_t w = windows.from; w < windows.to; ++w) ++counts[r.estimates.reason[p][w]];
  const auto worst = std::max_element(counts.begin() + 1, counts.end());
  return *worst == 0 ? "" : reason_word(static_cast<int>(worst - counts.begin()));
}

/// "1.2 N/m, fits": of the absolute value.
std::string model_error(const ModelFitTold* fit, std::size_t p, double value) {
  static constexpr std::array kWords{"", "fits", "only changes mean something", "does not fit"};
  if (fit == nullptr || fit->word[p] < 1 || fit->word[p] > 3) return "-";
  const char* word = kWords[static_cast<std::size_t>(fit->word[p])];
  return fit->word[p] == 3 ? word : number(fit->error[p] * value, 2) + ", " + word;
}

}  // namespace

std::string parameter_section(const SessionReport& r) {
  std::string out =
      "<h2>Table of parameters</h2>\n<p>Over every window that lies wholly in the stage. The "
      "standard error is that of one window; neighboring windows share nearly all their samples, "
      "so "
      "a mean of many is not that much better. It is the error of changes; the model's error is "
      "that of "
      "the absolute value, the same in every window, and the larger one counts for it.</p>\n";
  for (const ReportStage& stage : r.compared) {
    std::vector<std::vector<std::string>> rows;
    const ModelFitTold* fit = model_fit_at_end(r.estimates, stage.whole);
    for (std::size_t p = 0; p < r.estimates.parameters(); ++p) {
      const auto [factor, unit] = paper_unit(r.estimates.table.kind[p]);
      const ParameterSummary one = summarise(r.estimates, p, stage.whole);
      std::vector<std::string> row{html_text(r.estimates.table.name[p]), unit};
      for (const double value : {r.reference_static[p], r.reference_dynamic[p], one.mean})
        row.push_back(number(factor * value));
      row.push_back(number(factor * one.std_error, 2));
      row.push_back(model_error(fit, p, factor * one.mean));
      for (const double value : {one.boxplot.q1, one.boxplot.median, one.boxplot.q3})
        row.push_back(number(factor * value));
      row.push_back(ratio_percent(one.observable_ratio));
      row.push_back(ratio_percent(one.boxplot.median / r.reference_static[p] - 1, "{:+.1f}"));
      row.push_back(without(r, p, stage.whole));
      rows.push_back(std::move(row));
    }
    out += "<h3>" + html_text(stage.name) + "</h3>\n" +
           html_table(
               {"parameter", "unit", r.reference_from_drawings ? "reference-static" : "start value",
                "reference-dynamic", "mean", "standard error", "model's error", "q1", "median",
                "q3", "windows with value, %", "median to reference, %", "without, mostly"},
               rows);
  }
  return out;
}

std::string stages_section(const SessionReport& r) {
  if (r.stages.empty()) return "";
  std::vector<std::vector<std::string>> rows;
  for (const Stage& s : r.stages) {
    const WindowRange w = windows_within(r.estimates, s.from_us, s.to_us);
    rows.push_back({stage_word(s.kind), fmt::format("{:.1f}", session_seconds(r, s.from_us)),
                    fmt::format("{:.1f}", session_seconds(r, s.to_us)),
                    fmt::format("{:.1f}", s.seconds()), fmt::format("{}", w.size())});
  }
  return "<h3>Stages</h3>\n" +
         html_table({"stage", "from, s", "to, s", "length, s", "whole windows"}, rows) +
         "<p>Forced: the base moves. Free: the base rests and the building still moves.</p>\n";
}

std::string health_section(const SessionReport& r) {
  std::string out = "<h2>Health of the measurement</h2>\n";
  if (r.estimates.status) {
    const status_t& s = *r.estimates.status;
    out += fmt::format(
        "<p>{} windows published, {} instants used, {} gaps, {} messages refused, {} lost to a "
        "full "
        "queue (most that waited: {}).</p>\n",
        s.windows, s.sample_sets, s.gaps, s.rejected_messages, s.queue_dropped, s.queue_high_water);
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < s.name.size(); ++i)
      rows.push_back({html_text(s.name[i]), fmt::format("{}", s.received[i]),
                      fmt::format("{}", s.lost[i]), fmt::format("{}", s.late[i]),
                      fmt::format("{}", s.repaired[i]), fmt::format("{}", s.rejected[i]),
                      fmt::format("{}", s.stuck[i]), fmt::format("{}", s.clipped[i]),
                      number(1e6 * s.noise_mps2_per_rthz[i], 3)});
    out += html_table({"channel", "received", "lost", "late", "repaired", "rejected", "stuck",
                       "clipped", "noise, um/s^2/sqrt(Hz)"},
                      rows);
  }
  return out;
}

}  // namespace framewatch::daemon
