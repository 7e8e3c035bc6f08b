#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <framewatch/history_status_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/config.h"
#include "daemon/history_keeper.h"
#include "daemon/raw_history.h"
#include "daemon/summary_history.h"

namespace framewatch::daemon {

/// [history] of a running estimation: raw samples, summaries, events. No call waits for the disk,
/// and none fails: what is lost is counted.
class History {
 public:
  /// `config`, with its history, must outlive this.
  explicit History(const Config& config);
  /// Puts everything on the disk, for a few seconds at most where it refuses.
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;

  void sample(const AccelSample& sample) { raw_.sample(sample); }
  void temperature(const temperature_t& temperature);
  /// What the estimation published.
  void message(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
    summaries_.message(channel, bytes);
  }
  /// Any clock that is never set, several times a second.
  void tick(std::int64_t now_us);
  history_status_t status() const;

 private:
  const Config& config_;
  HistoryKeeper keeper_;
  SummaryHistory summaries_;
  RawHistory raw_;
};

}  // namespace framewatch::daemon
