// SPDX-License-Identifier: MIT
#include "daemon/page/findings/answers.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/service/health.h"

namespace framewatch::daemon {
namespace {

constexpr double kSilent_s = 3;
constexpr int kAllStories = 8, kMaxSwayed = 5;
constexpr double kStronger = 1.2;  // times the newest shake: gets a separate line

std::vector<const Finding*> of_kind(const Known& known, FindingKind kind) {
  std::vector<const Finding*> out;
  for (const Finding& f : known.findings)
    if (f.kind == kind) out.push_back(&f);
  return out;
}

/// Appends a full stop unless the text ends with one.
std::string sentence(std::string text) {
  text = capitalized(std::move(text));
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

AnswerLine line_of(const Finding& f) {
  return {sentence(f.text), f.since_us, 0};
}

void say_who_knows(const std::vector<const Finding*>& findings, const Config& config, Answer& out) {
  for (const Finding* f : findings) {
    if (!f->acknowledged) continue;
    std::string place = place_name(f->place, config);
    if (place != f->place) place = capitalized(std::move(place));  // not the name of a channel
    out.more.push_back({f->who.empty() ? fmt::format("{} is acknowledged.", place)
                                       : fmt::format("{} is acknowledged by {}.", place, f->who)});
  }
}

Answer is_changed(const Known& k, const Config& config) {
  Answer out{"Is the building changed?", AnswerState::good};
  const std::vector<const Finding*> changes = of_kind(k, FindingKind::change);
  if (changes.size() == 1) {
    out.line = line_of(*changes.front());
    out.line.text = "Yes. " + out.line.text;
  } else if (!changes.empty()) {
    const auto first = std::min_element(changes.begin(), changes.end(),
                                        [](auto* a, auto* b) { return a->since_us < b->since_us; });
    out.line = {fmt::format("Yes, in {} places.", changes.size()), (*first)->since_us, 0};
    for (const Finding* f : changes) out.more.push_back(line_of(*f));
  }
  if (!changes.empty()) {
    const bool open = std::any_of(changes.begin(), changes.end(),
                                  [](const Finding* f) { return !f->acknowledged; });
    out.state = open ? AnswerState::bad : AnswerState::look;
    say_who_knows(changes, config, out);
    return out;
  }
  if (k.with_baseline == 0) {
    out.state = AnswerState::wait;
    out.line.text = "Not known yet: the baseline is still being learned, which needs motion.";
    return out;
  }
  out.line.text =
      k.with_baseline < k.watched
          ? fmt::format("No change found in {} of {} elements; the others have no baseline yet.",
                        k.with_baseline, k.watched)
          : fmt::format("No. None of {} elements differs from its baseline.", k.watched);
  if (k.observable < k.with_baseline)
    out.more.push_back(
        {fmt::format("{} of them have a value now; the others keep their last value "
                     "until the building moves more.",
                     k.observable)});
  return out;
}

Answer is_believed(const Known& k, const Config& config) {
  Answer out{"Can I trust this?", AnswerState::good};
  const std::vector<const Finding*> doubts = of_kind(k, FindingKind::belief);
  std::set<std::string> dead;
  for (const Finding* f : doubts)
    if (f->of_channel) dead.insert(f->place);
  for (const Finding* f : doubts) out.more.push_back(line_of(*f));
  if (!k.same_config) out.more.push_back({"The estimator runs with another configuration."});
  if (!k.samples || k.silent_s > kSilent_s) {
    out.state = k.samples ? AnswerState::bad : AnswerState::wait;
    out.line.text = k.samples ? fmt::format("No: no samples for {}. The values shown are old.",
                                            span_text(k.silent_s))
                              : "Not yet: no samples have come.";
  } else if (k.estimates && k.estimates_silent_s > kSilent_s) {
    out.state = AnswerState::bad;
    out.line.text = fmt::format("No: samples come, but there are no estimates for {}.",
                                span_text(k.estimates_silent_s));
  } else if (!out.more.empty()) {
    out.state = AnswerState::look;
    const bool one = doubts.size() == 1 && k.same_config;
    out.line = one ? out.more.front() : AnswerLine{"Only in part."};
    if (one) out.line.text = "Only in part. " + out.line.text;
    if (one) out.more.clear();
  } else if (!k.estimates) {
    out.state = AnswerState::wait;
    out.line.text = "Samples come; no window is complete yet.";
  } else {
    out.line.text = fmt::format("Yes. All {} sensors send", config.pipeline.axes.size());
    out.line.text +=
        k.residual && k.observable > 0
            ? fmt::format(
                  ", and the model leaves {} of the motion unexplained.",
                  *k.residual < 0.0005 ? "under 0.1 %" : fmt::format("{:.1f} %", 100 * *k.residual))
            : ".";
  }
  if (!dead.empty()) {
    const std::size_t all = config.pipeline.axes.size();
    out.more.push_back({fmt::format("{} of {} sensors are good.", all - dead.size(), all)});
  }
  say_who_knows(doubts, config, out);
  return out;
}

std::string story_words(const Shake& shake, const Config& config, int story) {
  const estimator::Structure& s = config.pipeline.structure;
  const estimator::PeakDrift peak = peak_drift(shake.peak, s, story);
  if (peak.frame < 0) return fmt::format("Story {}: not known", story);
  return fmt::format(
      "Story {}: {} ({:.2f} mm) in {}", story, drift_words(peak.ratio),
      1e3 * peak.ratio * s.story_height[static_cast<std::size_t>(story - 1)],
      frame_words(s.frame_name(peak.frame), frame_labels(config.pipeline.structure)));
}

/// Returns "Story 3: 0.42 % ± 0.01 % (12.60 mm) in frame y1", from the drifts where known.
std::string drift_line(const Known& k, const Config& config, int story) {
  const estimator::Structure& s = config.pipeline.structure;
  const auto i = static_cast<std::size_t>(story - 1);
  if (i >= k.drifts.size()) return story_words(*k.newest, config, story);
  const estimator::StoryDrift& d = k.drifts[i];
  if (!d.known()) return fmt::format("Story {}: not known", story);
  return fmt::format("Story {}: {} ({:.2f} mm) in {}{}{}", story, drift_with_error(d),
                     1e3 * d.ratio * s.story_height[i],
                     frame_words(s.frame_name(d.frame), frame_labels(config.pipeline.structure)),
                     d.measured ? "" : ", computed",
                     d.interrupted_at_peak() ? "; unknown in part of the strong motion" : "");
}

/// Returns a line for each story from the top; in a tall building, for those with most drift.
void add_stories(const Known& k, const Config& config, Answer& out) {
  const estimator::Structure& s = config.pipeline.structure;
  const Shake& shake = *k.newest;
  std::vector<int> stories(static_cast<std::size_t>(s.stories));
  std::iota(stories.rbegin(), stories.rend(), 1);
  if (s.stories > kAllStories) {
    const auto swayed = [&](int story) {
      const estimator::PeakDrift peak = peak_drift(shake.peak, s, story);
      return peak.frame < 0 ? -1 : peak.ratio;
    };
    std::ranges::stable_sort(stories, std::greater<>(), swayed);
    stories.resize(kMaxSwayed);
  }
  for (const int story : stories) out.more.push_back({drift_line(k, config, story)});
  if (s.stories > kAllStories)
    out.more.push_back({fmt::format("The other {} stories swayed less.", s.stories - kMaxSwayed)});
}

std::string accel_words(const Shake& shake, const Config& config) {
  const auto words = [](double mps2) {
    return std::isfinite(mps2) ? fmt::format("{:.2f} m/s²", mps2) : std::string("not known");
  };
  double floors = estimator::kNaN;
  for (int level = 1; level <= config.pipeline.structure.stories; ++level)
    if (const double peak = peak_accel_mps2(shake.peak, config.pipeline.axes, level);
        !(peak <= floors))
      floors = peak;
  return fmt::format("Peak acceleration of the ground {}, of the floors {}",
                     words(peak_accel_mps2(shake.peak, config.pipeline.axes, 0)), words(floors));
}

/// Returns true when the strong motion of the report lies within the shake.
bool is_of(const EventReportSummary& report, const Shake& shake) {
  return report.start_us >= shake.from_us && report.start_us <= shake.to_us;
}

void name_report(const Known& k, Answer& out) {
  if (!k.report) return;
  const EventReportSummary& r = *k.report;
  const bool same = k.newest != nullptr && is_of(r, *k.newest);
  const std::string color = color_word(r.color);
  AnswerLine line{same ? fmt::format("Judged {}: {}.", color, r.reason)
                       : fmt::format("The last strong motion was judged {}: {}.", color, r.reason),
                  same ? 0 : r.start_us, same ? 0 : r.end_us, r.name};
  const bool changed = std::any_of(k.findings.begin(), k.findings.end(), [](const Finding& f) {
    return f.kind == FindingKind::change && !f.acknowledged;
  });
  if (r.color == EventColor::green && changed) {  // found since
    line.text += " Since then a change was found: see above.";
    if (out.state == AnswerState::good) out.state = AnswerState::look;
  }
  if (same && r.color != EventColor::green && out.state != AnswerState::bad)
    out.state = r.color == EventColor::red ? AnswerState::bad : AnswerState::look;
  out.more.insert(out.more.begin(), std::move(line));
  if (r.placard.empty()) return;
  const AnswerLine placard{
      fmt::format("Placard: {}. {} {}", r.placard, r.placard_reason, placard_caution())};
  out.more.insert(out.more.begin(), placard);
  if (same && r.placard == "unsafe") out.state = AnswerState::bad;
  if (same && r.placard != "inspected" && out.state == AnswerState::good)
    out.state = AnswerState::look;
}

Answer went_through(const Known& k, const Config& config) {
  Answer out{"What did it just go through?", AnswerState::good};
  if (k.newest == nullptr) {
    out.state = k.followed_since_us == 0 ? AnswerState::wait : AnswerState::good;
    out.line = {k.followed_since_us == 0
                    ? "Not known yet."
                    : fmt::format("Nothing: no acceleration over {:g} m/s².", Shaking::kMoves_mps2),
                k.followed_since_us, 0};
    name_report(k, out);
    return out;
  }
  const Shake& shake = *k.newest;
  const bool over = shake.over || k.silent_s > kSilent_s;
  const estimator::Structure& s = config.pipeline.structure;
  const double drift = largest_drift_ratio(shake.peak, s);
  const std::string swayed =
      drift > 0 ? fmt::format("a story swayed by up to {} of its height (drift ratio)",
                              drift_words(drift))
                : std::string("how far its stories swayed is not known");
  out.line = {
      fmt::format("{}: {}; the force at the base (shear) was up to {}.",
                  over ? "A shake" : "It is shaking", swayed, base_shear_words(shake.peak, s)),
      shake.from_us, over ? shake.to_us : 0};
  out.state = over ? AnswerState::good : AnswerState::look;
  add_stories(k, config, out);
  out.more.push_back({accel_words(shake, config)});
  if (k.strongest != nullptr && largest_drift_ratio(k.strongest->peak, s) > kStronger * drift)
    out.more.push_back({fmt::format("The strongest so far: {} of a story's height, {}.",
                                    drift_words(largest_drift_ratio(k.strongest->peak, s)),
                                    base_shear_words(k.strongest->peak, s)),
                        k.strongest->from_us, k.strongest->to_us});
  name_report(k, out);
  return out;
}

Answer to_do(const Known& k) {
  Answer out{"What should I do?", AnswerState::good};
  std::vector<const Finding*> open;
  for (const Finding& f : k.findings)
    if (!f.acknowledged && f.severity >= severity::warning) open.push_back(&f);
  std::stable_sort(open.begin(), open.end(), [](const Finding* a, const Finding* b) {
    return a->kind != b->kind ? a->kind < b->kind : a->severity > b->severity;
  });
  std::vector<std::string> steps;
  if (k.samples && k.silent_s > kSilent_s)
    steps.emplace_back("Run `framewatch status` to find out why no samples come.");
  else if (k.estimates && k.estimates_silent_s > kSilent_s)
    steps.emplace_back("Run `framewatch status` to find out why there are no estimates.");
  for (const Finding* f : open)
    if (std::find(steps.begin(), steps.end(), f->advice) == steps.end()) steps.push_back(f->advice);
  if (!k.same_config)
    steps.emplace_back(
        "Restart framewatch serve or framewatch run, so that both use the same configuration.");
  if (steps.empty()) {
    out.line.text = !k.samples             ? "Start framewatch run and the source of the samples."
                    : k.with_baseline == 0 ? "Wait until the baseline is learned."
                                           : "Nothing.";
    out.state = k.samples && k.with_baseline > 0 ? AnswerState::good : AnswerState::wait;
    return out;
  }
  out.line.text = capitalized(steps.front());
  for (std::size_t i = 1; i < steps.size(); ++i) out.more.push_back({capitalized(steps[i])});
  out.state = !open.empty() && open.front()->kind == FindingKind::change ? AnswerState::bad
                                                                         : AnswerState::look;
  return out;
}

}  // namespace

std::array<Answer, 4> answers(const Known& known, const Config& config) {
  return {is_changed(known, config), is_believed(known, config), went_through(known, config),
          to_do(known)};
}

}  // namespace framewatch::daemon
