// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <framewatch/acknowledge_t.hpp>

#include "daemon/base/log.h"
#include "daemon/config/keys/fleet_options.h"
#include "fleet/message/message.h"
#include "fleet/uplink/sent_store.h"

namespace framewatch::fleet {

/// Executes the commands of the hub that [fleet] accept allows, each once, and records them in the
/// journal. An answer is JSON: {"ok": true} or {"ok": false, "why": "..."}.
class CommandDesk {
 public:
  static constexpr std::size_t kMaxBytes = 65536, kMaxRaw = 8;
  static constexpr std::int64_t kMaxRaw_bytes = 256'000'000;
  /// Sends the request to the daemon. Returns an empty text, or why the daemon refused it.
  using Acknowledge = std::function<std::string(const acknowledge_t& request)>;

  /// All must outlive this.
  CommandDesk(const daemon::FleetSettings& settings, SentStore& store, Acknowledge acknowledge)
      : settings_(settings), store_(store), acknowledge_(std::move(acknowledge)) {}

  /// Executes a command and returns the answer. verb: from the subject. host_us: host clock.
  std::string obey(std::string_view verb, const Message& command, std::int64_t host_us);

  /// Returns true once after a command that changed what must be sent.
  bool changed_what_waits() { return std::exchange(changed_, false); }
  std::int64_t obeyed() const { return obeyed_; }
  std::int64_t refused() const { return refused_; }

 private:
  std::string check(std::string_view verb, const Message& command, std::int64_t host_us) const;
  std::string carry_out(std::string_view verb, const Message& command);
  std::string acknowledge(const Message& command);
  std::string raw(const Message& command);

  const daemon::FleetSettings& settings_;
  SentStore& store_;
  Acknowledge acknowledge_;
  daemon::RateLimitedLog warnings_{daemon::LogLevel::warning};
  bool changed_ = false;
  std::int64_t obeyed_ = 0, refused_ = 0;
};

}  // namespace framewatch::fleet
