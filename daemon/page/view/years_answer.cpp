// SPDX-License-Identifier: MIT
#include "daemon/page/view/years_answer.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/json.h"
#include "daemon/base/utc_time.h"
#include "daemon/base/words.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/monitor/estimates/summary_intake.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_points.h"
#include "daemon/monitor/history/history_request.h"

namespace framewatch::daemon {
namespace {

constexpr unsigned kBadRequest = 400, kUnknown = 404, kUnavailable = 503;
constexpr std::int64_t kMostEvents = 200, kMostNotes = 200;
constexpr const char* kNumber = "{:.7g}";

/// Returns the span that the request asks for. The last days end with a whole step.
HistoryExtent asked_span(const YearsRequest& r, const HistoryExtent& all) {
  std::int64_t from_us = r.from_us.value_or(all.first_us), to_us = r.to_us.value_or(all.end_us);
  if (r.last_us) {
    const std::int64_t step_us = least_step_s(all.end_us - *r.last_us, all.end_us) * kSecond_us;
    to_us = floor_to(all.end_us - 1, step_us) + step_us;
    from_us = to_us - *r.last_us;
  }
  return {from_us, to_us};
}

std::string element_json(const SummaryParameter& parameter, SummaryQuery& summaries,
                         const HistorySpan& span, const WeatherModel& model) {
  const ElementPoints points = element_points(parameter, summaries, span);
  const bool known = model.effects && model.effects->knows(parameter.name);
  return fmt::format(
      R"({{"name":{},"unit":{},"q1":{},"median":{},"q3":{},"covered":{},"corrected":{}}})",
      json_text(parameter.name), json_text(parameter.unit), json_list(points.q1, kNumber),
      json_list(points.median, kNumber), json_list(points.q3, kNumber),
      json_list(points.covered, "{:.4g}"),
      known ? json_list(corrected_points(parameter.name, points, span, *model.effects), kNumber)
            : "null");
}

std::string weather_json(const WeatherPoints& w) {
  return fmt::format(R"({{"name":{},"mean":{},"min":{},"max":{}}})", json_text(w.name),
                     json_list(w.mean, kNumber), json_list(w.min, kNumber),
                     json_list(w.max, kNumber));
}

std::string event_line_json(const event_t& e) {
  return json_line({{"id", e.id},
                    {"time_us", e.time_us},
                    {"since_us", e.since_us},
                    {"severity", e.severity},
                    {"kind", e.kind},
                    {"place", e.place},
                    {"message", e.message}});
}

std::string note_json(const StoredAcknowledgement& a) {
  return json_line({{"id", a.id},
                    {"time_us", a.time_us},
                    {"kind", a.kind},
                    {"place", a.place},
                    {"who", a.who},
                    {"comment", a.comment}});
}

std::string model_json(const WeatherModel& model) {
  constexpr std::array kStates = {"fitting", "ready", "failed"};
  Json out = {{"state", kStates[static_cast<std::size_t>(model.state)]},
              {"problem", model.problem},
              {"days", 0},
              {"covariates", Json::array()}};
  if (model.effects) {
    out["days"] = model.effects->weather.size();
    out["covariates"] = model.effects->covariates;
  }
  return json_line(out);
}

}  // namespace

std::optional<YearsRequest> read_years_request(const std::string& from, const std::string& to,
                                               const std::string& last, const std::string& elements,
                                               const std::string& only, std::string& problem) {
  YearsRequest out;
  const auto time = [&](const char* name, const std::string& text,
                        std::optional<std::int64_t>& read) {
    if (text.empty()) return;
    read = read_utc(text);
    if (!read)
      problem = fmt::format("{}: \"{}\" is not a time such as 2026-11-21T23:15:00Z", name, text);
  };
  time("from", from, out.from_us);
  time("to", to, out.to_us);
  if (!last.empty()) {
    out.last_us = read_duration(last);
    if (!out.last_us)
      problem = fmt::format("last: \"{}\" is not a duration such as 90m, 2h or 365d", last);
    else if (!from.empty() || !to.empty())
      problem = "last cannot be combined with from or to";
  }
  if (out.from_us && out.to_us && *out.from_us >= *out.to_us) problem = "from must be before to";
  for (std::size_t at = 0; at < elements.size();) {
    const std::size_t end = std::min(elements.find(',', at), elements.size());
    out.elements.push_back(elements.substr(at, end - at));
    at = end + 1;
  }
  if (out.elements.size() > YearsRequest::kMostElements)
    problem = fmt::format("elements: {} at once; {} are allowed", out.elements.size(),
                          YearsRequest::kMostElements);
  out.only_elements = only == "elements";
  if (!only.empty() && !out.only_elements)
    problem = fmt::format("only: \"{}\" is not \"elements\"", only);
  return problem.empty() ? std::optional(std::move(out)) : std::nullopt;
}

YearsAnswer answer_years(const YearsRequest& request, SummaryQuery& summaries,
                         const std::optional<HistoryExtent>& all, const WeatherModel& model) {
  const std::vector<SummaryParameter> known = summaries.parameters();
  std::vector<std::string> names;
  for (const SummaryParameter& p : known) names.push_back(p.name);
  std::vector<SummaryParameter> chosen;
  for (const std::string& name : request.elements) {
    const auto at = std::ranges::find(known, name, &SummaryParameter::name);
    if (at == known.end() && !known.empty())
      return {kUnknown,
              fmt::format("elements: the history has no {}{}", name, did_you_mean(name, names))};
    if (at != known.end()) chosen.push_back(*at);
  }
  HistorySpan span;
  if (all) {
    const HistoryExtent asked = asked_span(request, *all);
    std::string problem;
    const auto found = choose_span(summaries, asked.first_us, asked.end_us, problem);
    if (!found) return {kBadRequest, problem};
    span = *found;
  }
  const bool more = all && !request.only_elements;
  const std::int64_t raised = more ? summaries.count_raised(span.from_us, span.to_us) : 0;
  const std::vector<event_t> events =
      more ? summaries.raised_events(span.from_us, span.to_us, kMostEvents)
           : std::vector<event_t>();
  const std::vector<StoredAcknowledgement> notes =
      more ? summaries.acknowledgements(span.from_us, span.to_us, kMostNotes)
           : std::vector<StoredAcknowledgement>();
  const std::vector<WeatherPoints> weather =
      more ? weather_points(summaries, span) : std::vector<WeatherPoints>();
  YearsAnswer out;
  out.text = fmt::format(
      R"({{"first_us":{},"end_us":{},"from_us":{},"to_us":{},"begin_us":{},"step_s":{},"period_s":{},"points":{},)",
      all ? std::to_string(all->first_us) : "null", all ? std::to_string(all->end_us) : "null",
      span.from_us, span.to_us, all ? span.start_us(0) : 0, span.step_s, span.period_s,
      all ? span.points() : 0);
  out.text +=
      R"("elements":)" +
      bracketed(
          chosen,
          [&](const SummaryParameter& p) { return element_json(p, summaries, span, model); }, ",");
  out.text += R"(,"weather":)" + bracketed(weather, weather_json, ",");
  out.text += R"(,"model":)" + model_json(model);
  out.text += R"(,"events":)" + bracketed(events, event_line_json, ",");
  out.text += fmt::format(R"(,"events_in_all":{},"notes":)", raised) +
              bracketed(notes, note_json, ",") + "}";
  if (const std::string problem = summaries.problem(); !problem.empty())
    return {kUnavailable, "the history cannot be read: " + problem};
  return out;
}

}  // namespace framewatch::daemon
