#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/page/view/page_json.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

Json line_json(const AnswerLine& line) {
  return {{"text", line.text},
          {"since_us", line.since_us},
          {"until_us", line.until_us},
          {"report", line.report}};
}

}  // namespace

std::string answers_json(const Known& known, const Config& config) {
  constexpr const char* kStates[] = {"good", "look", "bad", "wait"};
  constexpr const char* kKinds[] = {"change", "shake", "belief", "service"};
  Json questions = Json::array(), findings = Json::array(), drift = Json::array();
  for (const Answer& a : answers(known, config)) {
    Json more = Json::array();
    for (const AnswerLine& line : a.more) more.push_back(line_json(line));
    questions.push_back({{"question", a.question},
                         {"state", kStates[static_cast<int>(a.state)]},
                         {"line", line_json(a.line)},
                         {"more", more}});
  }
  for (const Finding& f : known.findings)
    findings.push_back({{"id", f.id},
                        {"kind", kKinds[static_cast<int>(f.kind)]},
                        {"severity", f.severity},
                        {"place", f.place},
                        {"since_us", f.since_us},
                        {"ratio", json_value(f.change_ratio)},
                        {"error", json_value(f.std_error)},
                        {"of_channel", f.of_channel},
                        {"text", f.text},
                        {"advice", f.advice},
                        {"acknowledged", f.acknowledged},
                        {"who", f.who}});
  const estimator::Structure& s = config.pipeline.structure;
  for (int story = 1; known.newest != nullptr && story <= s.stories; ++story) {
    const estimator::PeakDrift peak = peak_drift(known.newest->peak, s, story);
    const auto i = static_cast<std::size_t>(story - 1);
    drift.push_back({{"ratio", json_value(peak.ratio)},
                     {"frame", peak.frame},
                     {"std_error", json_value(i < known.drifts.size() ? known.drifts[i].std_error
                                                                      : estimator::kNaN)}});
  }
  return json_line({{"answers", questions}, {"findings", findings}, {"drift", drift}});
}

}  // namespace framewatch::daemon
