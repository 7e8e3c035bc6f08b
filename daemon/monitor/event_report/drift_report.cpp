#include "daemon/monitor/event_report/drift_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>
#include <fmt/format.h>

#include "daemon/monitor/event_report/drift_words.h"

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
    case PlacardReason::gap:
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

/// "story 2", "stories 1 to 6", "stories 1, 3, 5 and 4 more"; ascending.
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

/// Why the first of the stories that are not judged could not be.
std::string why_not(const std::vector<int>& stories, const std::vector<StoryDrift>& drifts) {
  const StoryDrift& first = drifts[static_cast<std::size_t>(stories.front() - 1)];
  return open_reason(!first.known()        ? PlacardReason::drift_unknown
                     : first.gap_at_peak() ? PlacardReason::gap
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

/// One sentence for every thing that a reader of drifts must know.
std::vector<std::string> remarks_of(const std::vector<StoryDrift>& drifts,
                                    const estimator::PipelineConfig& c,
                                    const estimator::DriftKnowledge& known) {
  std::vector<std::string> out;
  out.push_back(
      "Permanent drift is in none of the numbers: accelerations do not show it. Look for stories "
      "that stand out of plumb.");
  double slow = 0;
  bool unknown_slow = false, computed = false;
  std::vector<int> gaps, unknown;
  for (const StoryDrift& d : drifts) {
    if (!d.known()) unknown.push_back(d.story);
    if (!d.known()) continue;
    if (d.gap_at_peak()) gaps.push_back(d.story);
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
  if (!gaps.empty())
    out.push_back(
        fmt::format("The drift of {} is unknown in part of the strong motion, because the record "
                    "begins in it or samples are missing: the peak may be larger.",
                    stories_words(gaps)));
  if (!unknown.empty())
    out.push_back(
        fmt::format("The drift of {} is not known: channels failed, or the record begins "
                    "in the motion.",
                    stories_words(unknown)));
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
                             capitalised(loss), out.reason);
  }
  return out;
}

}  // namespace framewatch::daemon
