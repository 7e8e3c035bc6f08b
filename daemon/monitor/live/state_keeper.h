// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <future>
#include <string>

#include "daemon/config/sections/settings.h"
#include "daemon/monitor/estimation/estimation.h"

namespace framewatch::daemon {

/// Writes the state of a running estimation periodically from a thread, so that a slow disk does
/// not delay estimates.
class StateKeeper {
 public:
  /// Without a `path` it writes nothing. `every_s` is the period.
  StateKeeper(std::string path, int every_s);

  /// Starts a write when one is due. `config` is that of the estimation.
  void update(const Config& config, Estimation& estimation, std::int64_t now_us);
  /// Makes the next write due at once, because the stored state belongs to an old configuration.
  void soon() { next_us_ = 1; }
  /// Writes now and waits until the write is done.
  void keep(const Config& config, Estimation& estimation);

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::int64_t written_us() const { return written_us_; }  ///< host clock; 0: not yet
  const std::string& problem() const { return problem_; }  ///< of the newest write; empty: success

 private:
  bool written();
  void report(std::string problem);

  std::string path_;
  std::int64_t every_us_, next_us_ = 0, written_us_ = 0;
  std::string problem_;
  std::future<std::string> writing_;  ///< of std::async: its destructor waits
};

}  // namespace framewatch::daemon
