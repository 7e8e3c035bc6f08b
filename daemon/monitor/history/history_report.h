#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include "daemon/base/damaged_database.h"
#include "daemon/base/once_a_second.h"
#include "daemon/config/config.h"
#include "daemon/monitor/events/raised_events.h"
#include "daemon/monitor/history/history.h"

namespace framewatch::daemon {

/// Raises an event when samples or summaries cannot be written to the disk, and clears it, with the
/// number of losses, when they can be written again. Raises another when a corrupt database was set
/// aside, which a person has to look at: it stays until the program ends.
class HistoryMonitor {
 public:
  /// now_us: the host's clock. Returns the events since the last call.
  std::vector<event_t> update(std::int64_t now_us, const history_status_t& status,
                            const SetAside& set_aside = {});

 private:
  struct Part {
    std::int64_t since_us = 0, id = 0, lost_before = 0, lost_seen = 0, well_since_us = 0;
    bool raised = false;
  };
  std::optional<event_t> news(Part& part, const char* place, const std::string& trouble,
                              std::int64_t lost, const history_status_t& status,
                              std::int64_t now_us);

  std::optional<event_t> new_database(const SetAside& set_aside, const history_status_t& status,
                                      std::int64_t now_us);

  Part raw_, summaries_;
  std::int64_t set_aside_seen_ = 0;
  event_t database_{};
};

/// The history of a running estimation, where one is configured, and what is to be said about it:
/// history_status_t every second, events and log lines when the disk stops or begins to take it.
class HistoryReport {
 public:
  /// Both must outlive this.
  HistoryReport(const Config& config, lcm::LCM& lcm);

  /// Null when none is configured.
  History* history() { return history_ ? &*history_ : nullptr; }
  /// Its own events that are raised.
  RaisedEvents& raised() { return raised_; }
  /// Call it several times a second. Returns the events that it published. now_us: host clock.
  std::vector<event_t> update(std::int64_t now_us);

 private:
  const Config& config_;
  lcm::LCM& lcm_;
  OnceASecond second_;
  HistoryMonitor monitor_;
  RaisedEvents raised_;
  std::optional<History> history_;
};

}  // namespace framewatch::daemon
