// SPDX-License-Identifier: MIT
#include "daemon/monitor/event_report/drift_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/core.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "daemon/base/html_page.h"
#include "daemon/base/json.h"
#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/change_words.h"

namespace framewatch::daemon {
namespace {

using estimator::Placard;
using estimator::PlacardChoice;
using estimator::PlacardReason;
using estimator::StoryDrift;

std::string story_sentence(const StoryDrift& drift) {
  return fmt::format("Story {} drifted {}{}", drift.story, drift_with_error(drift),
                     drift.measured ? "" : " (computed)");
}

std::string open_reason(PlacardReason reason, const StoryDrift& drift) {
  switch (reason) {
    case PlacardReason::drift_unknown:
      return fmt::format("the drift of story {} is not known", drift.story);
    case PlacardReason::interruption:
      return fmt::format(
          "the drift of story {} is unknown in part of its strong motion: its peak may be larger "
          "than the {} that was seen",
          drift.story, drift_words(drift.ratio));
    default:
      return fmt::format(
          "the error of the drift of story {} is not known: no stiffness was identified",
          drift.story);
  }
}

/// Returns "story 2", "stories 1 to 6" or "stories 1, 3, 5 and 4 more". `stories` is ascending.
std::string stories_words(const std::vector<int>& stories) {
  constexpr std::size_t kMaxNamed = 8;
  if (stories.size() == 1) return fmt::format("story {}", stories.front());
  const bool row = stories.back() - stories.front() + 1 == static_cast<int>(stories.size());
  if (row && stories.size() > 2)
    return fmt::format("stories {} to {}", stories.front(), stories.back());
  std::string out = "stories ";
  for (std::size_t i = 0; i < std::min(stories.size(), kMaxNamed); ++i)
    out += fmt::format("{}{}", i == 0 ? "" : ", ", stories[i]);
  if (stories.size() > kMaxNamed) out += fmt::format(" and {} more", stories.size() - kMaxNamed);
  return out;
}

/// Returns why the first of the `stories`, which are not judged, could not be judged.
std::string why_not(const std::vector<int>& stories, const std::vector<StoryDrift>& drifts) {
  const StoryDrift& first = drifts[static_cast<std::size_t>(stories.front() - 1)];
  return open_reason(!first.known()                ? PlacardReason::drift_unknown
                     : first.interrupted_at_peak() ? PlacardReason::interruption
                                                   : PlacardReason::error_unknown,
                     first);
}

std::string reason_words(const PlacardChoice& choice, const std::vector<StoryDrift>& drifts) {
  const StoryDrift& drift = drifts[static_cast<std::size_t>(choice.story - 1)];
  std::string out;
  if (choice.reason == PlacardReason::damage || choice.reason == PlacardReason::no_damage)
    out = fmt::format(
        "{}: {} damage is {} likely", story_sentence(drift),
        state_word(choice.state) +
            std::string(choice.state == estimator::DamageState::complete ? "" : " or worse"),
        probability_words(choice.probability));
  else
    out = "Not judged: " + open_reason(choice.reason, drift);
  if (choice.reason == PlacardReason::no_damage) out += ", and no other story is more likely to be";
  if (!choice.judged && choice.reason == PlacardReason::damage)
    out += fmt::format(". It may be worse: {} could not be judged, because {}",
                       stories_words(choice.not_judged), why_not(choice.not_judged, drifts));
  return out + ".";
}

/// Returns one sentence for each point that a reader of drifts must know.
std::vector<std::string> remarks_of(const std::vector<StoryDrift>& drifts,
                                    const estimator::PipelineConfig& c,
                                    const estimator::DriftKnowledge& known) {
  std::vector<std::string> out;
  out.push_back(
      "Permanent drift is in none of the numbers: accelerations do not show it. Look for stories "
      "that stand out of plumb.");
  double slow = 0;
  bool unknown_slow = false, computed = false;
  std::vector<int> interrupted, unknown;
  for (const StoryDrift& d : drifts) {
    if (!d.known()) unknown.push_back(d.story);
    if (!d.known()) continue;
    if (d.interrupted_at_peak()) interrupted.push_back(d.story);
    computed = computed || !d.measured;
    unknown_slow = unknown_slow || !std::isfinite(d.slow_ratio);
    if (std::isfinite(d.slow_ratio)) slow = std::max(slow, std::abs(d.slow_ratio) / d.ratio);
  }
  if (unknown_slow)
    out.push_back(
        fmt::format("The stiffness was not known yet when the peak passed, so elastic drift slower "
                    "than {:g} Hz "
                    "is missing; the error counts it{}.",
                    c.options.high_pass_hz,
                    known.theta.empty() ? " as not known" : " by the building's lowest frequency"));
  else if (slow > 0)
    out.push_back(fmt::format(
        "Elastic drift slower than {:g} Hz does not survive the integration and is restored from "
        "the floors' forces and the identified stiffness: up to {:.0f} % of a peak.",
        c.options.high_pass_hz, 100 * slow));
  if (computed)
    out.push_back(
        "Computed: the floor or the one below has no channel. Its motion follows from the measured "
        "floors by the design's shares of the stories between them; a loss in one of these stories "
        "alone is not in its error.");
  if (!interrupted.empty())
    out.push_back(
        fmt::format("The drift of {} is unknown in part of the strong motion, because the record "
                    "begins in it or samples are missing: the peak may be larger.",
                    stories_words(interrupted)));
  if (!unknown.empty())
    out.push_back(
        fmt::format("The drift of {} is not known: channels failed, or the record begins "
                    "in the motion.",
                    stories_words(unknown)));
  return out;
}

std::string part(double error, const estimator::StoryDrift& drift) {
  return std::isfinite(error) && drift.ratio > 0 ? fmt::format("{:.1f}", 100 * error / drift.ratio)
                                                 : "-";
}

/// Returns a probability for a table cell: "35 %", "&lt; 1 %".
std::string in_table(double probability) {
  if (!std::isfinite(probability)) return "-";
  return probability < 0.01   ? "&lt; 1 %"
         : probability > 0.99 ? "&gt; 99 %"
                              : fmt::format("{:.0f} %", 100 * probability);
}

Json story_json(const DriftReport& r, std::size_t i, const Config& config) {
  const estimator::StoryDrift& d = r.drifts[i];
  Json out{{"story", d.story},
           {"peak_drift_ratio", json_value(d.ratio)},
           {"drift_is", d.measured ? "measured" : "computed"},
           {"std_error_ratio", json_value(d.std_error)},
           {"error_parts_ratio",
            {{"noise", json_value(d.noise_error)},
             {"corner", json_value(d.slow_error)},
             {"model", json_value(d.known() ? d.model_error : estimator::kNaN)}}},
           {"restored_ratio", json_value(d.slow_ratio)},
           {"frame", d.known() ? Json(config.pipeline.structure.frame_name(d.frame)) : Json()},
           {"gap_at_peak", d.interrupted_at_peak()}};
  if (!r.placard) return out;
  for (std::size_t state = 0; state < estimator::kDamageStates; ++state)
    out["probability_or_worse"][state_word(static_cast<estimator::DamageState>(state))] =
        json_value(r.damage[i][state]);
  return out;
}

const char* placard_word(estimator::Placard placard) {
  constexpr const char* kWords[] = {"inspected", "restricted_use", "unsafe"};
  return kWords[static_cast<std::size_t>(placard)];
}

const char* reason_word(estimator::PlacardReason reason) {
  constexpr const char* kWords[] = {"damage", "no_damage", "drift_unknown", "gap_at_peak",
                                    "error_unknown"};
  return kWords[static_cast<std::size_t>(reason)];
}

Json fragility_json(const FragilitySettings& f) {
  Json out{{"source", f.source},
           {"type", f.type.empty() ? Json() : Json(f.type)},
           {"restricted_probability", f.rules.restricted},
           {"unsafe_probability", f.rules.unsafe},
           {"stories", Json::array()}};
  for (const estimator::Fragility& one : f.by_story)
    out["stories"].push_back({{"median_drift_ratio", one.median}, {"dispersion", one.dispersion}});
  return out;
}

}  // namespace

DriftReport drift_report(const Config& config, const estimator::PipelineConfig& pipeline,
                         const estimator::PeakResponse& peak,
                         const estimator::DriftKnowledge& known, const std::string& loss) {
  DriftReport out;
  out.drifts = story_drifts(pipeline, peak, known);
  out.remarks = remarks_of(out.drifts, pipeline, known);
  if (!config.fragility) {
    out.reason =
        "No fragility is configured, so damage is not judged: give [fragility] type = \"C1\" "
        "or whatever the building is, and design_level.";
    return out;
  }
  out.damage = story_damage(out.drifts, config.fragility->by_story);
  out.placard = choose_placard(out.drifts, out.damage, config.fragility->rules);
  out.reason = reason_words(*out.placard, out.drifts);
  if (!loss.empty() && out.placard->placard == Placard::inspected) {
    out.placard->placard = Placard::restricted;
    out.reason = fmt::format("{}, though by its drifts alone the building would pass. {}",
                             capitalized(loss), out.reason);
  }
  return out;
}

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
      row.push_back(
          html_text(frame_words(s.frame_name(d.frame), frame_labels(config.pipeline.structure))));
    } else {
      row.insert(row.end(), {"-", "-"});
    }
    row.push_back(std::string(d.measured ? "measured" : "computed") +
                  (d.known() && d.interrupted_at_peak() ? "; interrupted" : ""));
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

void add_drifts(const DriftReport& r, const Config& config, nlohmann::ordered_json& to) {
  to["stories"] = Json::array();
  for (std::size_t i = 0; i < r.drifts.size(); ++i)
    to["stories"].push_back(story_json(r, i, config));
  to["placard"] = nullptr;
  if (r.placard)
    to["placard"] = {{"placard", placard_word(r.placard->placard)},
                     {"words", placard_words(*r.placard)},
                     {"because", reason_word(r.placard->reason)},
                     {"reason", r.reason},
                     {"story", r.placard->story},
                     {"stories_not_judged", r.placard->not_judged},
                     {"caution", placard_caution()}};
  to["fragility"] = config.fragility ? fragility_json(*config.fragility) : Json();
  if (!r.placard) to["no_placard"] = r.reason;
  to["drift_remarks"] = r.remarks;
}

std::string drifts_json(const DriftReport& r, const Config& config) {
  Json out{{"schema", "framewatch.drifts/1"},
           {"building", config.pipeline.structure.name},
           {"config_sha256", config.sha256},
           {"version", FRAMEWATCH_VERSION}};
  add_drifts(r, config, out);
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace framewatch::daemon
