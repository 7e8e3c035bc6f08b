#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/monitor/event_report/drift_report.h"
#include "daemon/monitor/event_report/drift_words.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kStates[] = {"slight", "moderate", "extensive", "complete"};

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
           {"gap_at_peak", d.gap_at_peak()}};
  if (!r.placard) return out;
  for (std::size_t state = 0; state < estimator::kDamageStates; ++state)
    out["probability_or_worse"][kStates[state]] = json_value(r.damage[i][state]);
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
