// SPDX-License-Identifier: MIT
#include "fleet/hub/setup.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace setup_test {

using nlohmann::json;

constexpr std::size_t kParts = 10;  // five streams, a consumer each

/// Keeps configurations like JetStream.
struct FakeJetStream {
  std::map<std::string, json> parts;  // by STREAM or STREAM.CONSUMER
  int changes = 0;
  bool refuses = false;

  std::optional<std::string> ask(const std::string& subject, const std::string& text,
                                 std::string& error) {
    const std::string api = "$JS.API.";
    if (!subject.starts_with(api)) {
      error = "timeout";
      return std::nullopt;
    }
    const std::string call = subject.substr(api.size());
    const auto after = [&](const std::string& begin) {
      return call.starts_with(begin) ? call.substr(begin.size()) : "";
    };
    for (const char* info : {"STREAM.INFO.", "CONSUMER.INFO."})
      if (const std::string name = after(info); !name.empty()) {
        const auto found = parts.find(name);
        if (found != parts.end()) return json{{"config", found->second}}.dump();
        return R"({"error":{"code":404,"description":"not found"}})";
      }
    if (refuses) return R"({"error":{"code":500,"description":"insufficient storage resources"}})";
    ++changes;
    for (const char* change : {"STREAM.CREATE.", "STREAM.UPDATE.", "CONSUMER.DURABLE.CREATE."})
      if (const std::string name = after(change); !name.empty()) {
        const json request = json::parse(text);
        parts[name] = request.contains("config") ? request["config"] : request;
        // Like the server, leaves out zeros and adds fields.
        for (auto at = parts[name].begin(); at != parts[name].end();)
          at = *at == json(false) ? parts[name].erase(at) : std::next(at);
        parts[name]["compression"] = "none";
        return R"({"type":"io.nats.jetstream.api.v1.stream_create_response"})";
      }
    return R"({"error":{"code":400,"description":"bad request"}})";
  }
  AskHub asker() {
    return
        [this](const std::string& s, const std::string& j, std::string& e) { return ask(s, j, e); };
  }
};

TEST(Setup, CreatesMissingPartsAndLeavesTheRest) {
  FakeJetStream hub;
  const auto parts = hub_parts(3, 1000);
  ASSERT_EQ(parts.size(), kParts);
  const SetupOutcome first = set_up(parts, hub.asker(), false);
  EXPECT_TRUE(first.problems.empty());
  EXPECT_EQ(first.changed, static_cast<int>(kParts));
  const SetupOutcome second = set_up(parts, hub.asker(), false);
  EXPECT_EQ(second.changed, 0);
  EXPECT_EQ(hub.changes, static_cast<int>(kParts));
  EXPECT_EQ(second.lines.front(), "FW_EVENT: correct");
}

TEST(Setup, ReportsDifferencesAndChangesThemUnlessOnlyChecking) {
  FakeJetStream hub;
  (void)set_up(hub_parts(3, 1000), hub.asker(), false);
  hub.parts["FW_EVENT"]["max_bytes"] = 5;
  const SetupOutcome looked = set_up(hub_parts(3, 1000), hub.asker(), true);
  EXPECT_EQ(looked.changed, 1);
  EXPECT_EQ(looked.lines.front(), "FW_EVENT: max_bytes 5 -> 2147483648");
  EXPECT_EQ(hub.parts["FW_EVENT"]["max_bytes"], 5);
  EXPECT_EQ(set_up(hub_parts(3, 1000), hub.asker(), false).changed, 1);
  EXPECT_EQ(set_up(hub_parts(3, 1000), hub.asker(), true).changed, 0);
}

TEST(Setup, ReportsEachRefusalAndTriesTheOtherParts) {
  FakeJetStream hub;
  hub.refuses = true;
  const SetupOutcome out = set_up(hub_parts(3, 1000), hub.asker(), false);
  EXPECT_EQ(out.problems.size(), kParts);
  EXPECT_NE(out.problems.front().find("insufficient storage"), std::string::npos);
}

TEST(Setup, ReportsMalformedAnswersOfTheServer) {
  for (const char* answer :
       {"", "[]", "null", R"({"error":5})", R"({"error":{"code":"x"}})", "{"}) {
    const SetupOutcome out = set_up(
        hub_parts(1, 1),
        [&](const std::string&, const std::string&, std::string&) {
          return std::optional<std::string>(answer);
        },
        true);
    EXPECT_EQ(out.problems.size(), kParts) << answer;
  }
}

TEST(Setup, AFullRawStreamRefusesAndOtherStreamsDropTheOldest) {
  for (const HubPart& part : hub_parts(3, 1000)) {
    if (!part.consumer.empty()) continue;
    const json config = json::parse(part.config);
    EXPECT_EQ(config["discard"] == "new", part.stream == "FW_RAW" || part.stream == "FW_JOB");
    EXPECT_EQ(config["num_replicas"], 3);
    EXPECT_GE(config["max_bytes"].get<std::int64_t>(), 64 << 20);
  }
}

}  // namespace setup_test
}  // namespace framewatch::fleet
