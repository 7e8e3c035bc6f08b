#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"
#include "daemon/event_report/event_report.h"
#include "daemon/event_report/unheard_words.h"
#include "daemon/events/event_words.h"
#include "daemon/events/place_words.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr double kErrors = 3;  // standard errors a loss is beyond

struct Reason {
  EventColor color;
  double size;  ///< over its threshold
  std::string text;
};

EventColor color_of(double value, double yellow, double red) {
  return value >= red ? EventColor::red : value >= yellow ? EventColor::yellow : EventColor::green;
}

void judge_drifts(const EventReport& r, const Config& config, EventVerdict& out,
                  std::vector<Reason>& reasons) {
  const EventReportSettings& s = *config.event_report;
  for (int story = 1; story <= config.pipeline.structure.stories; ++story) {
    const double ratio = peak_drift(r.shaking.peak, config.pipeline.structure, story).ratio;
    if (!std::isfinite(ratio)) {
      reasons.push_back(
          {EventColor::yellow, 0,
           fmt::format("the drift of story {} is not known: its sensors failed", story)});
      continue;
    }
    if (out.worst_story == 0 || ratio > out.worst_drift_ratio) {
      out.worst_story = story;
      out.worst_drift_ratio = ratio;
    }
    const EventColor color = color_of(ratio, s.yellow_drift_ratio, s.red_drift_ratio);
    const double limit = color == EventColor::red ? s.red_drift_ratio : s.yellow_drift_ratio;
    if (color != EventColor::green)
      reasons.push_back(
          {color, ratio / limit,
           fmt::format("story {} drifted by {}{:.2f} % of its height ({}limit {:g} %)", story,
                       r.shaking.unheard.empty() ? "" : "at least ", 100 * ratio,
                       drift_is_measured(config.pipeline, story) ? "" : "computed, ",
                       100 * limit)});
  }
}

/// Number of stiffnesses that could be compared.
int judge_losses(const EventReport& r, const Config& config, std::vector<Reason>& reasons) {
  const EventReportSettings& s = *config.event_report;
  const estimator::ParameterTable table = config.pipeline.parameters();
  int known = 0;
  for (int p = 0; p < table.elements(); ++p) {
    const estimator::ShakenStiffness& k = r.shaking.stiffness[static_cast<std::size_t>(p)];
    if (!k.known()) continue;
    ++known;
    const double loss = -k.ratio();
    const EventColor color = color_of(loss, s.yellow_loss_ratio, s.red_loss_ratio);
    if (color == EventColor::green || loss < kErrors * k.std_error()) continue;
    const double limit = color == EventColor::red ? s.red_loss_ratio : s.yellow_loss_ratio;
    reasons.push_back(
        {color, loss / limit,
         fmt::format("{} ({}) lost {:.1f} % (+-{:.1f} %) of its stiffness (limit {:g} %)",
                     element_words(table[p].name), table[p].name, 100 * loss,
                     std::max(0.1, 100 * k.std_error()), 100 * limit)});
  }
  return known;
}

}  // namespace

const char* color_word(EventColor color) {
  return color == EventColor::red ? "red" : color == EventColor::yellow ? "yellow" : "green";
}

EventVerdict judge(const EventReport& r, const Config& config) {
  EventVerdict out;
  std::vector<Reason> reasons;
  judge_drifts(r, config, out, reasons);
  const int known = judge_losses(r, config, reasons);
  // Nobody knows the peaks of the time that was not heard, so it is not green.
  for (const std::string& unheard : unheard_sentences(r.shaking))
    reasons.push_back({EventColor::yellow, 0, unheard});
  std::stable_sort(reasons.begin(), reasons.end(), [](const Reason& a, const Reason& b) {
    return a.color != b.color ? a.color > b.color : a.size > b.size;
  });
  for (const Reason& reason : reasons) out.reasons.push_back(reason.text);
  if (!reasons.empty()) out.color = reasons.front().color;
  if (reasons.empty())
    out.reasons.push_back(fmt::format("no story drifted by more than {:.3f} % of its height",
                                      100 * out.worst_drift_ratio));
  const auto all = static_cast<int>(r.shaking.stiffness.size());
  if (known == 0)
    out.reasons.push_back(
        "no stiffness could be compared: the building moved too little or too "
        "shortly");
  else if (reasons.empty())
    out.reasons.push_back(fmt::format("none of {} stiffnesses (of {}) lost {:g} % or more", known,
                                      all, 100 * config.event_report->yellow_loss_ratio));
  return out;
}

std::string event_report_name(const EventReport& r) {
  return "event-" + utc_stamp(to_microseconds(r.shaking.start));
}

event_t event_of(const EventReport& r, const Config& config) {
  const EventVerdict verdict = judge(r, config);
  event_t m{};
  m.time_us = to_microseconds(r.shaking.found);
  m.since_us = to_microseconds(r.shaking.start);
  m.id = m.since_us;
  m.state = event_state::raised;
  m.severity = verdict.color == EventColor::green    ? severity::information
               : verdict.color == EventColor::yellow ? severity::warning
                                                     : severity::alarm;
  m.kind = "strong_motion";
  m.place = verdict.worst_story > 0 ? fmt::format("story {}", verdict.worst_story) : "";
  m.value = verdict.worst_story > 0 ? 100 * verdict.worst_drift_ratio : estimator::kNaN;
  m.std_error = estimator::kNaN;
  m.unit = "%";
  m.segment = event_report_name(r) + ".html";
  const std::string unheard = unheard_words(r.shaking);
  m.message =
      fmt::format("after strong motion: {}{}, {}; report {}", unheard.empty() ? "" : unheard + "; ",
                  color_word(verdict.color), verdict.reasons.front(), m.segment);
  return m;
}

bool green_and_past(const event_t& e, std::int64_t now_us) {
  return e.kind == "strong_motion" && e.severity == severity::information &&
         1e-6 * static_cast<double>(now_us - e.time_us) >= kGreenShown_s;
}

}  // namespace framewatch::daemon
