// SPDX-License-Identifier: MIT
#include "fleet/hub/setup.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::int64_t kMiB = 1 << 20, kGiB = 1024 * kMiB;
constexpr std::int64_t kSecond_ns = 1'000'000'000, kDay_ns = 86'400 * kSecond_ns;
constexpr std::int64_t kLeast_bytes = 64 * kMiB;
constexpr int kBuildings = 1000;  // number of buildings for the sizes below

struct Stream {
  const char* name;
  std::vector<std::string> subjects;
  std::int64_t max_age_ns, max_bytes, max_message_bytes, per_subject;
  bool discards_new, is_queue, is_read_directly;
  const char* consumer;
};

std::vector<Stream> streams() {
  std::vector<std::string> last;
  for (const char* kind : {"service", "status", "history", "watch", "acknowledged", "parameters",
                           "config", "inventory"})
    last.push_back(std::string("fw.up.*.") + kind);
  return {
      {"FW_EVENT",
       {"fw.up.*.event"},
       400 * kDay_ns,
       2 * kGiB,
       64 * 1024,
       100'000,
       false,
       false,
       false,
       "store"},
      {"FW_SUMMARY",
       {"fw.up.*.summary.*"},
       7 * kDay_ns,
       8 * kGiB,
       128 * 1024,
       -1,
       false,
       false,
       false,
       "store"},
      {"FW_LAST", last, 0, 512 * kMiB, 256 * 1024, 1, false, false, true, "page"},
      {"FW_RAW",
       {"fw.up.*.raw.>"},
       14 * kDay_ns,
       4 * kGiB,
       256 * 1024,
       -1,
       true,
       false,
       false,
       "store"},
      {"FW_JOB", {"fw.job.>"}, 0, 64 * kMiB, 64 * 1024, -1, true, true, false, "diagnose"},
  };
}

std::int64_t scaled(std::int64_t bytes, int buildings) {
  return std::max(kLeast_bytes, bytes * buildings / kBuildings);
}

json stream_config(const Stream& s, int replicas, int buildings) {
  return {{"name", s.name},
          {"subjects", s.subjects},
          {"retention", s.is_queue ? "workqueue" : "limits"},
          {"storage", "file"},
          {"num_replicas", replicas},
          {"max_age", s.max_age_ns},
          {"max_bytes", scaled(s.max_bytes, buildings)},
          {"max_msg_size", s.max_message_bytes},
          {"max_msgs", -1},
          {"max_msgs_per_subject", s.per_subject},
          {"max_consumers", 16},
          {"discard", s.discards_new ? "new" : "old"},
          {"duplicate_window", 600 * kSecond_ns},
          {"deny_delete", !s.is_queue},
          {"allow_direct", s.is_read_directly}};
}

/// Messages of a worker that died are delivered again after ack_wait; events have a shorter wait.
json consumer_config(const Stream& stream) {
  const std::int64_t wait_s = std::string_view(stream.name) == "FW_EVENT" ? 8 : 30;
  return {{"durable_name", stream.consumer},
          {"deliver_policy", "all"},
          {"ack_policy", "explicit"},
          {"ack_wait", wait_s * kSecond_ns},
          {"max_ack_pending", 2000},
          {"max_deliver", -1},
          {"max_waiting", 64},
          {"replay_policy", "instant"}};
}

using nlohmann::json;

constexpr int kNotFound = 404;

std::string name_of(const HubPart& part) {
  return part.consumer.empty() ? part.stream : part.stream + "/" + part.consumer;
}

/// Returns nullopt and sets the reason when the hub refuses or its answer is not understood.
/// Returns an object without "config" when the part does not exist.
std::optional<json> asked(const AskHub& ask, const std::string& subject, const json& request,
                          std::string& error) {
  const auto answer = ask("$JS.API." + subject, request.is_null() ? "" : request.dump(), error);
  if (!answer) return std::nullopt;
  json document = json::parse(*answer, nullptr, false);
  if (!document.is_object()) {
    error = "the answer is not from JetStream";
    return std::nullopt;
  }
  const auto failure = document.find("error");
  if (failure == document.end()) return document;
  const auto member = [&](const char* name) {
    return failure->is_object() && failure->contains(name) ? (*failure)[name] : json();
  };
  if (member("code") == kNotFound && request.is_null()) return json::object();
  const json why = member("description");
  error = why.is_string() ? why.get<std::string>() : "refused";
  return std::nullopt;
}

/// Returns the checked values that differ: "max_bytes 1 -> 2, ...".
std::string differences(const json& is, const json& should_be) {
  std::string out;
  for (const auto& [key, wanted] : should_be.items()) {
    const auto found = is.find(key);
    // The server leaves out values that are null, false or zero.
    const bool absent = found == is.end();
    if (absent && (wanted == 0 || wanted == false)) continue;
    if (!absent && *found == wanted) continue;
    out += fmt::format("{}{} {} -> {}", out.empty() ? "" : ", ", key,
                       absent ? "none" : found->dump(), wanted.dump());
  }
  return out;
}

std::string info_subject(const HubPart& part) {
  return part.consumer.empty() ? "STREAM.INFO." + part.stream
                               : fmt::format("CONSUMER.INFO.{}.{}", part.stream, part.consumer);
}

/// Returns the API call that creates the part, or changes it if it exists.
std::pair<std::string, json> making(const HubPart& part, bool is_there) {
  const json config = json::parse(part.config);
  if (part.consumer.empty())
    return {fmt::format("STREAM.{}.{}", is_there ? "UPDATE" : "CREATE", part.stream), config};
  return {fmt::format("CONSUMER.DURABLE.CREATE.{}.{}", part.stream, part.consumer),
          {{"stream_name", part.stream}, {"config", config}}};
}

}  // namespace

std::vector<HubPart> hub_parts(int replicas, int buildings) {
  std::vector<HubPart> out;
  for (const Stream& s : streams()) {
    out.push_back({s.name, "", stream_config(s, replicas, buildings).dump()});
    out.push_back({s.name, s.consumer, consumer_config(s).dump()});
  }
  return out;
}

SetupOutcome set_up(const std::vector<HubPart>& parts, const AskHub& ask, bool only_look) {
  SetupOutcome out;
  for (const HubPart& part : parts) {
    const std::string name = name_of(part);
    std::string error;
    const auto info = asked(ask, info_subject(part), nullptr, error);
    if (!info) {
      out.problems.push_back(fmt::format("{}: {}", name, error));
      continue;
    }
    const auto config = info->find("config");
    const bool is_there = config != info->end();
    const std::string differs =
        is_there ? differences(*config, json::parse(part.config)) : "missing";
    if (differs.empty()) {
      out.lines.push_back(name + ": correct");
      continue;
    }
    ++out.changed;
    if (only_look) {
      out.lines.push_back(fmt::format("{}: {}", name, differs));
      continue;
    }
    const auto [subject, request] = making(part, is_there);
    if (asked(ask, subject, request, error))
      out.lines.push_back(is_there ? fmt::format("{}: changed: {}", name, differs)
                                   : name + ": made");
    else
      out.problems.push_back(fmt::format("{}: {} ({})", name, error, differs));
  }
  return out;
}

}  // namespace framewatch::fleet
