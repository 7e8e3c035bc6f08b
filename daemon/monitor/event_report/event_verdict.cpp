// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/utc_time.h"
#include "daemon/monitor/event_report/event_report.h"
#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr double kErrors = 3;  // a loss must exceed this many standard errors

struct Reason {
  EventColor color;
  double size;  ///< relative to its threshold
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

/// Returns the reason for an element that has a record. An open alarm is never green.
Reason reason_of(const estimator::ChangeRecord& record, const estimator::Parameter& p,
                 const Config& config) {
  const EventReportSettings& s = *config.event_report;
  const estimator::Change& c = record.change;
  if (!record.measured())
    return {EventColor::yellow, 1,
            changing_sentence(p, c.ratio, frame_labels(config.pipeline.structure))};
  const double loss = loss_of_one_story(p, std::clamp(-c.ratio, 0.0, 1.0));
  const bool red = loss >= s.red_loss_ratio;
  return {
      red ? EventColor::red : EventColor::yellow,
      loss / (red ? s.red_loss_ratio : s.yellow_loss_ratio),
      fmt::format("{} (limit {:g} %{})",
                  change_sentence(p, c.ratio, c.std_error, frame_labels(config.pipeline.structure)),
                  100 * (red ? s.red_loss_ratio : s.yellow_loss_ratio),
                  p.last_story > p.story ? " of one story" : "")};
}

/// Counts of the stiffnesses that could be compared, and of those whose error hides the limit.
struct Compared {
  int known = 0, hidden = 0;
  double shows = 0;  ///< the smallest loss of one story that every hidden one would show
};

Compared judge_losses(const EventReport& r, const Config& config, EventVerdict& verdict,
                      std::vector<Reason>& reasons) {
  const EventReportSettings& s = *config.event_report;
  const estimator::ParameterTable table = config.pipeline.parameters();
  Compared out;
  double gravest = 0;
  const auto take_loss = [&](double loss) {
    if (loss > gravest) verdict.loss = reasons.back().text;
    gravest = std::max(gravest, loss);
  };
  for (int i = 0; i < table.elements(); ++i) {
    const estimator::ShakenStiffness& k = r.shaking.stiffness[static_cast<std::size_t>(i)];
    const estimator::Parameter& p = table[i];
    if (k.record.id != 0) {
      reasons.push_back(reason_of(k.record, p, config));
      if (k.record.measured()) take_loss(-k.record.change.ratio);
    }
    if (!k.known()) continue;
    ++out.known;
    if (k.record.id != 0) continue;
    const double shows = kErrors * k.std_error();
    if (shows > loss_of_group(p, s.yellow_loss_ratio)) {
      ++out.hidden;
      out.shows = std::max(out.shows, loss_of_one_story(p, std::min(shows, 1.0)));
    }
    if (k.watched) continue;  // [watch] judges it
    const double loss = -k.ratio(), of_story = loss_of_one_story(p, std::clamp(loss, 0.0, 1.0));
    const EventColor color = color_of(of_story, s.yellow_loss_ratio, s.red_loss_ratio);
    if (color == EventColor::green || loss < shows) continue;
    const double limit = color == EventColor::red ? s.red_loss_ratio : s.yellow_loss_ratio;
    const bool group = p.last_story > p.story;
    reasons.push_back(
        {color, of_story / limit,
         fmt::format("{} ({}) lost {:.1f} % (+-{:.1f} %) of {} stiffness{} (limit {:g} %)",
                     element_words(p.name, frame_labels(config.pipeline.structure)), p.name,
                     100 * loss, std::max(0.1, 100 * k.std_error()), group ? "their" : "its",
                     group ? fmt::format(", one of stories {} to {} up to {:.0f} %", p.story,
                                         p.last_story, 100 * of_story)
                           : std::string(),
                     100 * limit)});
    take_loss(loss);
  }
  if (r.everything.id != 0)
    reasons.push_back(
        {EventColor::yellow, 1,
         common_change_sentence(r.everything.change.ratio, r.everything.measured()
                                                               ? r.everything.change.std_error
                                                               : estimator::kNaN)});
  for (const event_t& e : r.open)
    reasons.push_back({EventColor::yellow, 0, fmt::format("an alarm is open: {}", e.message)});
  return out;
}

}  // namespace

const char* color_word(EventColor color) {
  return color == EventColor::red ? "red" : color == EventColor::yellow ? "yellow" : "green";
}

EventVerdict judge(const EventReport& r, const Config& config) {
  EventVerdict out;
  std::vector<Reason> reasons;
  judge_drifts(r, config, out, reasons);
  const Compared compared = judge_losses(r, config, out, reasons);
  // The peaks of the time without samples are not known, so the verdict is not green.
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
  const bool grouped = config.pipeline.parameters().grouped();
  const auto watched = std::count_if(r.shaking.stiffness.begin(), r.shaking.stiffness.end(),
                                     [](const auto& k) { return k.watched; });
  if (compared.known == 0)
    out.reasons.push_back(
        "no stiffness could be compared: the building moved too little or too "
        "shortly");
  else if (reasons.empty() && compared.known > compared.hidden)
    out.reasons.push_back(fmt::format(
        "none of {} stiffnesses (of {}) lost {:g} % or more{}", compared.known - compared.hidden,
        all, 100 * config.event_report->yellow_loss_ratio, grouped ? " of one story" : ""));
  if (compared.hidden > 0)
    out.reasons.push_back(
        fmt::format("{} stiffnesses are not judged to {:g} %{}, because their errors are larger: a "
                    "loss of {:.0f} % would have shown",
                    compared.hidden, 100 * config.event_report->yellow_loss_ratio,
                    grouped ? " of one story" : "", std::ceil(100 * compared.shows)));
  if (config.watch && watched == 0)
    out.reasons.push_back("[watch] has no baseline yet: it compares nothing");
  return out;
}

DriftReport drift_report(const EventReport& r, const Config& config) {
  return drift_report(config, config.pipeline, r.shaking.peak, r.shaking.known,
                      judge(r, config).loss);
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
  const DriftReport drifts = drift_report(r, config);
  if (verdict.worst_story > 0)
    m.std_error = 100 * drifts.drifts[static_cast<std::size_t>(verdict.worst_story - 1)].std_error;
  const std::string unheard = unheard_words(r.shaking);
  m.message = fmt::format(
      "after strong motion: {}{}, {}; {}report {}", unheard.empty() ? "" : unheard + "; ",
      color_word(verdict.color), verdict.reasons.front(),
      drifts.placard ? "placard: " + placard_words(*drifts.placard) + "; " : "", m.segment);
  return m;
}

bool green_and_past(const event_t& e, std::int64_t now_us) {
  return e.kind == "strong_motion" && e.severity == severity::information &&
         1e-6 * static_cast<double>(now_us - e.time_us) >= kGreenShown_s;
}

}  // namespace framewatch::daemon
