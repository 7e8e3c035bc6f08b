#include "fleet/hub/stream_table.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <nlohmann/json.hpp>

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr std::int64_t kMiB = 1 << 20, kGiB = 1024 * kMiB;
constexpr std::int64_t kSecond_ns = 1'000'000'000, kDay_ns = 86'400 * kSecond_ns;
constexpr std::int64_t kLeast_bytes = 64 * kMiB;
constexpr int kBuildings = 1000;  // that the sizes below are for

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

/// What a worker that died had taken is given again after ack_wait or later: events sooner.
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

}  // namespace

std::vector<HubPart> hub_parts(int replicas, int buildings) {
  std::vector<HubPart> out;
  for (const Stream& s : streams()) {
    out.push_back({s.name, "", stream_config(s, replicas, buildings).dump()});
    out.push_back({s.name, s.consumer, consumer_config(s).dump()});
  }
  return out;
}

}  // namespace framewatch::fleet
