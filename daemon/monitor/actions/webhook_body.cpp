// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/webhook_body.h"

#include <cstddef>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

// Limits of the services, in bytes. Slack and PagerDuty count characters, which are fewer.
constexpr std::size_t kSlackText = 2500, kTeamsText = 4000, kNtfyText = 3500;
constexpr std::size_t kPagerDutySummary = 1000, kPagerDutyKey = 255;
constexpr std::size_t kTitle = 200;

std::string title(const event_t& e, const std::string& building) {
  return printable(fmt::format("{}: {}", building, state_words(e)), kTitle);
}

std::string when(const event_t& e) {
  return is_momentary(e) ? utc_text(e.time_us)
                         : fmt::format("{}, since {}", utc_text(e.time_us), utc_text(e.since_us));
}

/// Returns "stiffness_change kx_1_y1, event 3".
std::string what(const event_t& e) {
  return printable(e.kind + (e.place.empty() ? "" : " " + e.place), kTitle) +
         (is_momentary(e) ? "" : fmt::format(", event {}", e.id));
}

/// Escapes the characters that Slack reads as markup.
std::string slack_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

Json slack(const event_t& e, const std::string& building) {
  const std::string head = title(e, building), message = printable(e.message, kSlackText);
  const auto plain = [](const std::string& text) {
    return Json{{"type", "plain_text"}, {"text", text}, {"emoji", false}};
  };
  // `text` is for lists and read aloud; the blocks are shown. Plain text has no markup.
  return {{"text", slack_text(head + ": " + message)},
          {"blocks",
           {{{"type", "section"}, {"text", plain(head)}},
            {{"type", "section"}, {"text", plain(message)}},
            {{"type", "context"}, {"elements", Json::array({plain(what(e) + ", " + when(e))})}}}}};
}

/// Text runs have no markup, unlike text blocks, which would make kx_1_y1 italic.
Json teams_block(const std::string& text, const char* size, const char* weight, const char* color) {
  return {{"type", "RichTextBlock"},
          {"inlines", Json::array({Json{{"type", "TextRun"},
                                        {"text", text},
                                        {"size", size},
                                        {"weight", weight},
                                        {"color", color}}})}};
}

Json teams(const event_t& e, const std::string& building) {
  constexpr const char* kColors[] = {"Accent", "Warning", "Attention"};
  const char* color = e.state == event_state::cleared && !is_momentary(e)
                          ? "Good"
                          : kColors[e.severity >= severity::alarm     ? 2
                                    : e.severity == severity::warning ? 1
                                                                      : 0];
  const Json card{{"$schema", "http://adaptivecards.io/schemas/adaptive-card.json"},
                  {"type", "AdaptiveCard"},
                  {"version", "1.4"},
                  {"body",
                   {teams_block(title(e, building), "Medium", "Bolder", color),
                    teams_block(printable(e.message, kTeamsText), "Default", "Default", "Default"),
                    teams_block(what(e) + ", " + when(e), "Small", "Lighter", "Default")}}};
  return {
      {"type", "message"},
      {"attachments", Json::array({Json{{"contentType", "application/vnd.microsoft.card.adaptive"},
                                        {"contentUrl", nullptr},
                                        {"content", card}}})}};
}

Json ntfy(const event_t& e, const std::string& building, const std::string& topic) {
  const bool over = e.state == event_state::cleared && !is_momentary(e);
  const int priority = over                              ? 3
                       : e.severity >= severity::alarm   ? 5
                       : e.severity == severity::warning ? 4
                                                         : 3;
  return {{"topic", topic},
          {"title", title(e, building)},
          {"message", printable(e.message, kNtfyText) + "\n" + what(e) + ", " + when(e)},
          {"priority", priority},
          {"tags", Json::array({over                              ? "white_check_mark"
                                : e.severity >= severity::alarm   ? "rotating_light"
                                : e.severity == severity::warning ? "warning"
                                                                  : "information_source"})}};
}

Json pagerduty(const event_t& e, const std::string& building, const std::string& key) {
  constexpr const char* kLevels[] = {"info", "warning", "critical"};
  const bool over = e.state == event_state::cleared && !is_momentary(e);
  const std::string dedup =
      printable(fmt::format("{}/{}/{}", e.kind, e.id, building), kPagerDutyKey - 3);
  Json out{
      {"routing_key", key}, {"event_action", over ? "resolve" : "trigger"}, {"dedup_key", dedup}};
  if (over) return out;
  out["client"] = "framewatch";
  out["payload"] = {
      {"summary", printable(building + ": " + e.message, kPagerDutySummary)},
      {"source", printable(building, kTitle)},
      {"severity", kLevels[e.severity >= severity::alarm ? 2 : e.severity == severity::warning]},
      {"timestamp", utc_text(e.time_us)},
      {"component", e.place},
      {"class", e.kind},
      {"custom_details", Json::parse(event_json(e, building))}};
  return out;
}

}  // namespace

bool is_momentary(const event_t& e) {
  return e.state == event_state::cleared && e.since_us == e.time_us;
}

std::string state_words(const event_t& e) {
  return is_momentary(e)
             ? word(kSeverities, e.severity)
             : fmt::format("{} {}", word(kSeverities, e.severity), word(kEventStates, e.state));
}

std::string webhook_body(WebhookFormat format, const event_t& e, const std::string& building,
                         const std::string& topic, const std::string& key) {
  switch (format) {
    case WebhookFormat::slack:
      return json_line(slack(e, building));
    case WebhookFormat::teams:
      return json_line(teams(e, building));
    case WebhookFormat::ntfy:
      return json_line(ntfy(e, building, topic));
    case WebhookFormat::pagerduty:
      return json_line(pagerduty(e, building, key));
    case WebhookFormat::generic:
      break;
  }
  return event_json(e, building);
}

}  // namespace framewatch::daemon
