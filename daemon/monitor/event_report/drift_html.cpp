#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/monitor/event_report/drift_report.h"
#include "daemon/monitor/event_report/drift_words.h"

namespace framewatch::daemon {
namespace {

std::string part(double error, const estimator::StoryDrift& drift) {
  return std::isfinite(error) && drift.ratio > 0 ? fmt::format("{:.1f}", 100 * error / drift.ratio)
                                                 : "-";
}

/// Short: "35 %", "< 1 %".
std::string in_table(double probability) {
  if (!std::isfinite(probability)) return "-";
  return probability < 0.01   ? "&lt; 1 %"
         : probability > 0.99 ? "&gt; 99 %"
                              : fmt::format("{:.0f} %", 100 * probability);
}

}  // namespace

std::string placard_section(const DriftReport& r) {
  if (!r.placard) return "";
  return "<p class=\"verdict\">Placard: " + html_text(placard_words(*r.placard)) + ". " +
         html_text(r.reason) + "</p>\n<p>" + placard_caution() + "</p>\n";
}

std::string drift_table_section(const DriftReport& r, const Config& config) {
  const estimator::Structure& s = config.pipeline.structure;
  std::vector<std::string> head{"",
                                "peak drift, % of the height",
                                "mm",
                                "frame",
                                "that drift is",
                                "noise, %",
                                "corner, %",
                                "model, %"};
  if (r.placard)
    for (const char* state : {"slight", "moderate", "extensive", "complete"})
      head.push_back(state + std::string(" or worse"));
  if (r.placard) head.back() = "complete";
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = r.drifts.size(); i-- > 0;) {
    const estimator::StoryDrift& d = r.drifts[i];
    std::vector<std::string> row{fmt::format("story {}", d.story), drift_with_error(d)};
    if (d.known()) {
      row.push_back(fmt::format("{:.2f}", 1e3 * d.ratio * s.story_height[i]));
      row.push_back(html_text(s.frame_name(d.frame)));
    } else {
      row.insert(row.end(), {"-", "-"});
    }
    row.push_back(std::string(d.measured ? "measured" : "computed") +
                  (d.known() && d.gap_at_peak() ? "; unknown in part" : ""));
    row.insert(row.end(), {part(d.noise_error, d), part(d.slow_error, d),
                           d.measured ? "-" : part(d.model_error, d)});
    if (r.placard)
      for (const double p : r.damage[i]) row.push_back(in_table(p));
    rows.push_back(std::move(row));
  }
  std::string out = "<h2>Drift and damage of every story</h2>\n" + html_table(head, rows) +
                    "<p>± is one standard error; its parts, in % of the drift: the sensors' noise, "
                    "what the integration's corner removes, the model of floors without "
                    "channels.</p>\n";
  if (r.placard)
    out += fmt::format(
        "<p>Probabilities by {}. Restricted use from {:.0f} % for moderate damage, unsafe from "
        "{:.0f} % for extensive damage, of any story.</p>\n",
        html_text(config.fragility->source), 100 * config.fragility->rules.restricted,
        100 * config.fragility->rules.unsafe);
  else
    out += "<p>" + html_text(r.reason) + "</p>\n";
  out += "<ul>\n";
  for (const std::string& remark : r.remarks) out += "<li>" + html_text(remark) + "</li>\n";
  return out + "</ul>\n";
}

}  // namespace framewatch::daemon
