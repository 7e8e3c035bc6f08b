// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/webhook_body.h"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"

namespace framewatch::daemon {
namespace webhook_body_test {

using nlohmann::json;

json body(WebhookFormat format, const event_t& e) {
  return json::parse(webhook_body(format, e, "<north> & wing", "topic", "key"));
}

event_t momentary() {
  event_t e = event(7, event_state::cleared);
  e.since_us = e.time_us;
  return e;
}

TEST(WebhookBody, GenericIsTheEventItself) {
  EXPECT_EQ(webhook_body(WebhookFormat::generic, event(7), "b", "", ""), event_json(event(7), "b"));
}

TEST(WebhookBody, SlackShowsTextWithoutMarkup) {
  event_t e = event(7);
  e.message = "*bold* <!channel> & more";
  const json slack = body(WebhookFormat::slack, e);
  EXPECT_EQ(slack["text"],
            "&lt;north&gt; &amp; wing: alarm raised: *bold* &lt;!channel&gt; &amp; more");
  ASSERT_EQ(slack["blocks"].size(), 3u) << slack.dump(1);
  for (const json& block : slack["blocks"])
    for (const json& text :
         block.contains("text") ? json::array({block["text"]}) : block["elements"])
      EXPECT_EQ(text["type"], "plain_text") << block.dump();
  EXPECT_EQ(slack["blocks"][1]["text"]["text"], e.message);
  EXPECT_EQ(slack["blocks"][2]["elements"][0]["text"],
            "stiffness_change kx_1_y1, event 7, 2023-11-14T22:13:20.000Z, since "
            "2023-11-14T22:13:19.000Z");
}

TEST(WebhookBody, TeamsIsAnAdaptiveCard) {
  const json teams = body(WebhookFormat::teams, event(7));
  EXPECT_EQ(teams["type"], "message");
  ASSERT_EQ(teams["attachments"].size(), 1u);
  EXPECT_EQ(teams["attachments"][0]["contentType"], "application/vnd.microsoft.card.adaptive");
  const json& card = teams["attachments"][0]["content"];
  EXPECT_EQ(card["type"], "AdaptiveCard");
  ASSERT_EQ(card["body"].size(), 3u) << card.dump(1);
  EXPECT_EQ(card["body"][0]["inlines"][0]["text"], "<north> & wing: alarm raised");
  EXPECT_EQ(card["body"][0]["inlines"][0]["color"], "Attention");
  EXPECT_EQ(card["body"][1]["inlines"][0]["text"], event(7).message);
  const json over = body(WebhookFormat::teams, event(7, event_state::cleared));
  EXPECT_EQ(over["attachments"][0]["content"]["body"][0]["inlines"][0]["color"], "Good");
}

TEST(WebhookBody, NtfyRanksBySeverity) {
  const auto priority = [](const event_t& e) {
    return body(WebhookFormat::ntfy, e)["priority"].get<int>();
  };
  EXPECT_EQ(priority(event(7)), 5);
  EXPECT_EQ(priority(event(7, event_state::raised, severity::warning)), 4);
  EXPECT_EQ(priority(event(7, event_state::raised, severity::information)), 3);
  EXPECT_EQ(priority(event(7, event_state::cleared)), 3);
  EXPECT_EQ(priority(momentary()), 5);
  EXPECT_EQ(body(WebhookFormat::ntfy, event(7))["topic"], "topic");
}

TEST(WebhookBody, PagerDutyOpensAndResolvesTheSameIncident) {
  const json raised = body(WebhookFormat::pagerduty, event(7));
  const json changed = body(WebhookFormat::pagerduty, event(7, event_state::changed));
  const json cleared = body(WebhookFormat::pagerduty, event(7, event_state::cleared));
  EXPECT_EQ(raised["routing_key"], "key");
  EXPECT_EQ(raised["event_action"], "trigger");
  EXPECT_EQ(raised["payload"]["severity"], "critical");
  EXPECT_EQ(raised["payload"]["source"], "<north> & wing");
  EXPECT_EQ(raised["payload"]["component"], "kx_1_y1");
  EXPECT_EQ(raised["payload"]["custom_details"]["id"], 7);
  EXPECT_EQ(changed["event_action"], "trigger");
  EXPECT_EQ(cleared["event_action"], "resolve");
  EXPECT_FALSE(cleared.contains("payload"));
  EXPECT_EQ(raised["dedup_key"], changed["dedup_key"]);
  EXPECT_EQ(raised["dedup_key"], cleared["dedup_key"]);
  EXPECT_NE(raised["dedup_key"], body(WebhookFormat::pagerduty, event(8))["dedup_key"]);
  // Nothing follows a momentary event, so a resolution would tell nobody.
  EXPECT_EQ(body(WebhookFormat::pagerduty, momentary())["event_action"], "trigger");
}

TEST(WebhookBody, TextsOfAnyContentsStayWithinTheLimitsOfTheServices) {
  event_t e = event(7);
  for (int i = 0; i < 20000; ++i)
    e.message += i % 3 == 0 ? "\xe2\x88\x92" : i % 3 == 1 ? "\xff" : "\n";
  e.place = std::string(3000, 'p');
  const std::string building(5000, 'b');
  for (const WebhookFormat format : {WebhookFormat::slack, WebhookFormat::teams,
                                     WebhookFormat::ntfy, WebhookFormat::pagerduty}) {
    const std::string text = webhook_body(format, e, building, "t", "k");
    ASSERT_TRUE(json::accept(text));
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
  const json slack = json::parse(webhook_body(WebhookFormat::slack, e, building, "", ""));
  for (const json& block : slack["blocks"])
    if (block.contains("text")) {
      EXPECT_LE(block["text"]["text"].get<std::string>().size(), 3000u);
    }
  EXPECT_LE(slack["blocks"][2]["elements"][0]["text"].get<std::string>().size(), 3000u);
  const json ntfy = json::parse(webhook_body(WebhookFormat::ntfy, e, building, "t", ""));
  EXPECT_LE(ntfy["message"].get<std::string>().size(), 4096u);
  const json page = json::parse(webhook_body(WebhookFormat::pagerduty, e, building, "", "k"));
  EXPECT_LE(page["dedup_key"].get<std::string>().size(), 255u);
  EXPECT_LE(page["payload"]["summary"].get<std::string>().size(), 1024u);
}

}  // namespace webhook_body_test
}  // namespace framewatch::daemon
