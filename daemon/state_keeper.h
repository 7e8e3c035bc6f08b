#pragma once

#include <cstdint>
#include <future>
#include <string>

#include "daemon/config.h"
#include "daemon/estimation.h"

namespace framewatch::daemon {

/// Writes the state of a running estimation from time to time, in a thread: a slow disk delays no
/// estimate.
class StateKeeper {
 public:
  /// path: empty: none is kept. `config` must outlive this.
  StateKeeper(std::string path, int every_s, const Config& config);
  ~StateKeeper();
  StateKeeper(const StateKeeper&) = delete;
  StateKeeper& operator=(const StateKeeper&) = delete;

  void look(Estimation& estimation, std::int64_t now_us);
  /// As soon as the disk takes it: what is there belongs to another configuration.
  void soon() { next_us_ = 1; }
  /// Now, and waits for it.
  void keep(Estimation& estimation);

  bool wanted() const { return !path_.empty(); }
  const std::string& path() const { return path_; }
  std::int64_t written_us() const { return written_us_; }  ///< host clock; 0: not yet
  const std::string& problem() const { return problem_; }  ///< of the newest write; empty: none

 private:
  bool written();
  void report(std::string problem);

  std::string path_;
  std::int64_t every_us_, next_us_ = 0, written_us_ = 0;
  const Config& config_;
  std::string problem_;
  std::future<std::string> writing_;
};

}  // namespace framewatch::daemon
