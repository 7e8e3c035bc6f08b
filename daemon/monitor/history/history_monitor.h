#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <framewatch/event_t.hpp>
#include <framewatch/history_status_t.hpp>

#include "daemon/base/sqlite_file.h"

namespace framewatch::daemon {

/// Raises an event when samples or summaries cannot be written to the disk, and clears it, with the
/// number of losses, when they can be written again. Raises another when a corrupt database was set
/// aside, which a person has to look at: it stays until the program ends.
class HistoryMonitor {
 public:
  /// now_us: the host's clock. Returns the events since the last call.
  std::vector<event_t> look(std::int64_t now_us, const history_status_t& status,
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

}  // namespace framewatch::daemon
