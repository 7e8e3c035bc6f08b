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

/// Now, by a clock that is never set and by the host's.
struct Instant {
  std::int64_t steady_us = 0, host_us = 0;
};

struct UplinkSettings {
  daemon::FleetSettings fleet;
  daemon::HistorySettings history;
  std::string config;  ///< path of the configuration file
  std::string secret;  ///< that seals keys (message/key.h); empty: they go as they are
};

/// Sends what the history holds to the hub until the hub has acknowledged it, and what is heard on
/// LCM at once; obeys commands. All of it in one thread, by step(). docs/fleet.md has the rules.
class Uplink {
 public:
  static constexpr std::size_t kMaxLive = 1024;  ///< events of LCM that wait
  /// Acknowledgements that a hub may lose with its power.
  static constexpr std::int64_t kAgainAfterLoss_us = 600'000'000;
  static constexpr double kOlder_hz = 4;  ///< summaries of earlier hours

  /// `link` must outlive this.
  Uplink(UplinkSettings settings, Link& link, CommandDesk::Acknowledge acknowledge,
         std::unique_ptr<RawExporter> exporter, Instant now);

  /// LCM channels without the prefix.
  static std::vector<std::string> channels();
  /// A message of LCM.
  void heard(std::string_view channel, std::span<const std::uint8_t> bytes);
  /// Does what is to be done now; to be called when something has come, and several times a second.
  void step(Instant now);
  /// Stores what the hub has acknowledged; before the end.
  void finish(Instant now);
  uplink_status_t status(Instant now) const;

 private:
  void hear_link(Instant now);
  void hear_answer(std::int64_t number, const Message& answer, Instant now);
  void hear_command(const Message& command, Instant now);
  void note_acknowledged(const Outgoing& done, bool duplicate);
  void begin_connection();
  void store(Instant now, bool at_once);
  void look(Instant now);
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
  std::int64_t clock_us_;  ///< of acknowledgements when this began; never before an earlier one

  std::deque<event_t> live_;  ///< events heard and not yet under way
  Waiting waiting_;           ///< what the newest look() found
  std::size_t next_event_ = 0, next_period_ = 0;
  bool look_again_ = true, rewind_ = false;
  std::string again_;  ///< newest order to resend: keys are sealed anew, or all were repetitions
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
