// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/monitor/service/latest_messages.h"
#include "fleet/message/message.h"

namespace framewatch::fleet {

/// Decides when the messages of which the hub keeps only the newest (stream FW_LAST) are sent:
///
///   service        every 60 s, and when an event begins or ends
///   acknowledged   as the others, and when it changes
///   others         after restart(), when the configuration changes, and every 10 min
///   texts          after restart(), when the configuration changes, and every day
///
/// Call update() with each message and due() until it returns nullopt. Times are of a monotonic
/// clock.
class NewestMessages {
 public:
  static constexpr std::int64_t kService_us = 60'000'000, kOther_us = 600'000'000,
                                kText_us = 86'400'000'000;

  /// Returns the messages that update() takes.
  static std::vector<daemon::DaemonMessage> messages();

  /// Stores the payload of `changed`, which `latest` has just decoded. Ignores other messages.
  void update(const daemon::LatestMessages& latest, daemon::DaemonMessage changed,
              std::span<const std::uint8_t> payload);
  /// Stores a text of the uplink itself. kind: "config" or "inventory". type: "toml", "json".
  void set_text(const std::string& kind, const std::string& type, const std::string& content);
  /// Makes every message due, as after a new connection.
  void restart();

  struct Due {
    std::string kind, type;
    Bytes content;
  };
  /// Returns a message that is due and counts it as sent; nullopt when none is due.
  std::optional<Due> due(std::int64_t now_us);

  /// Returns the digest in the newest service_t or parameter_table_t; empty before the first.
  const std::string& config_sha256() const { return config_sha256_; }

 private:
  struct Newest {
    std::string type;
    Bytes content;
    std::optional<std::int64_t> given_us;
  };
  void config_is(const std::string& sha256);

  std::map<std::string, Newest> newest_;  ///< by kind
  std::string config_sha256_;
  std::vector<std::int64_t> raised_, acknowledged_;  ///< ids of events in the newest messages
};

}  // namespace framewatch::fleet
