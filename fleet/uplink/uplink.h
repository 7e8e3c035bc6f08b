// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/uplink_status_t.hpp>

#include "daemon/config/keys/fleet_options.h"
#include "daemon/config/keys/history_options.h"
#include "daemon/monitor/service/latest_messages.h"
#include "fleet/link/link.h"
#include "fleet/uplink/command_desk.h"
#include "fleet/uplink/newest_messages.h"
#include "fleet/uplink/outbox.h"
#include "fleet/uplink/raw_sender.h"
#include "fleet/uplink/send_window.h"
#include "fleet/uplink/sent_store.h"

namespace framewatch::fleet {

/// A moment on the monotonic clock and on the host clock.
struct Instant {
  std::int64_t steady_us = 0, host_us = 0;
};

struct UplinkSettings {
  daemon::FleetSettings fleet;
  daemon::HistorySettings history;
  std::string config;  ///< path of the configuration file
  std::string secret;  ///< seals keys (sealed_key()); empty: sends keys unsealed
};

/// Sends the content of the history to the hub until the hub acknowledges it, sends LCM messages at
/// once, and executes commands of the hub. All work happens in step(), in one thread. docs/fleet.md
/// has the rules.
class Uplink {
 public:
  static constexpr std::size_t kMaxLive = 1024;  ///< events from LCM that wait
  /// Age of the acknowledgements that a hub may lose in a power failure.
  static constexpr std::int64_t kAgainAfterLoss_us = 600'000'000;
  static constexpr double kOlder_hz = 4;  ///< rate of summaries of earlier hours

  /// `link` must outlive this.
  Uplink(UplinkSettings settings, Link& link, CommandDesk::Acknowledge acknowledge,
         std::unique_ptr<RawExporter> exporter, Instant now);

  /// Returns the LCM channels that heard() takes, without the prefix.
  static std::vector<std::string> channels();
  /// Takes an LCM message. channel: without the prefix. Ignores other channels and malformed bytes.
  void heard(std::string_view channel, std::span<const std::uint8_t> bytes);
  /// Does all work that is due. Call it after each message and several times a second.
  void step(Instant now);
  /// Stores the last acknowledgements. Call it at the end.
  void finish(Instant now);
  uplink_status_t status(Instant now) const;

 private:
  void hear_link(Instant now);
  void hear_answer(std::int64_t number, const Message& answer, Instant now);
  void hear_command(const Message& command, Instant now);
  void note_acknowledged(const Outgoing& done, bool duplicate);
  void begin_connection();
  void store(Instant now, bool at_once);
  void collect(Instant now);
  void say_inventory(Instant now);
  void say_config();
  void fill(Instant now);
  void hear_event(const event_t& event);
  bool add_event(const event_t& event, Instant now);
  bool fill_periods(Instant now);
  bool add(Outgoing outgoing, Instant now);
  void send(Instant now);
  std::int64_t clock_us(Instant now) const {
    return clock_us_ + (now.steady_us - begun_.steady_us);
  }
  bool waits_for_store() const {
    return !store_trouble_.empty() && unstored_keys_.size() > kMaxLive;
  }

  const UplinkSettings settings_;
  Link& link_;
  SentStore store_;
  Outbox outbox_;
  daemon::LatestMessages latest_{""};
  NewestMessages newest_;
  SendWindow window_;
  CommandDesk desk_;
  RawSender raw_;
  const Instant begun_;
  std::int64_t clock_us_;  ///< clock of acknowledgements at the start; never goes back

  std::deque<event_t> live_;  ///< events from LCM that are not yet under way
  Waiting waiting_;           ///< result of the newest collect()
  std::size_t next_event_ = 0, next_period_ = 0;
  bool look_again_ = true, rewind_ = false;
  std::string again_;  ///< newest resend command; seals keys anew, else all would be duplicates
  std::int64_t look_us_ = INT64_MIN, store_us_ = INT64_MIN, older_us_ = INT64_MIN,
               inventory_us_ = INT64_MIN;

  std::vector<SentEvent> unstored_events_;  ///< acknowledged, not yet stored
  std::vector<SentPeriod> unstored_summaries_;
  std::set<std::string> unstored_keys_;

  std::int64_t connections_ = 0, acknowledged_ = 0, acknowledged_us_ = 0, refused_ = 0,
               sent_bytes_ = 0, lost_live_ = 0;
  std::string refusal_, store_trouble_, outbox_trouble_, config_sent_;
};

}  // namespace framewatch::fleet
