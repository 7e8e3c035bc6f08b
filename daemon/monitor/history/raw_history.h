// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "drivers/files/durable_file.h"
#include "drivers/lcm/count_block.h"

namespace framewatch::daemon {

/// Writes raw samples as integers (accel_counts_t) into one log after the other. Never waits for
/// the disk: the thread of the log's DurableFile writes.
class RawHistory {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{32} << 20;
  static constexpr std::int64_t kTold_us = 60'000'000;
  /// Takes a log to close, which may take long.
  using Retire = std::function<void(std::unique_ptr<drivers::DurableFile>)>;

  struct Counters {
    std::int64_t samples = 0, dropped = 0;
    std::int64_t bytes = 0;  ///< written
    std::size_t queued = 0;  ///< waiting bytes
  };

  /// `config`, which has a history, must outlive this.
  RawHistory(const Config& config, Retire retire, std::size_t queue_bytes = kQueueBytes);

  void sample(const estimator::AccelSample& sample);
  /// Stores another message beside the samples, unchanged. Ignores messages before the first
  /// sample.
  void message(const std::string& channel, std::int64_t time_us,
               const std::vector<std::uint8_t>& bytes);
  /// Limits how long samples wait for their block to fill. Call it several times a second with the
  /// time of a clock that is never set.
  void tick(std::int64_t now_us);
  /// Writes the collected samples and passes the log to Retire.
  void finish();

  Counters counters() const;
  /// Returns why samples cannot be written. A log that somebody moved or removed is named for
  /// kTold_us after the next one has begun.
  std::string trouble() const;
  std::int64_t newest_us() const { return seconds_.newest_us(); }

 private:
  void end_block();
  /// Makes sure that the current log is open and starts with the channels' names.
  void ready_log(std::int64_t time_us);
  void rotate();
  void append(const std::string& channel, std::int64_t time_us,
              const std::vector<std::uint8_t>& bytes, std::size_t samples);

  const Config& config_;
  Retire retire_;
  std::size_t queue_bytes_;
  drivers::CountBlock block_;
  SensorSeconds seconds_;
  std::unique_ptr<drivers::DurableFile> log_;
  std::int64_t log_slot_ = 0, log_bytes_ = 0, log_events_ = 0;
  std::optional<std::int64_t> block_since_us_;  ///< when tick() first saw it
  std::optional<std::int64_t> lost_us_;         ///< when tick() last saw a lost log
  std::int64_t ticked_us_ = 0;
  std::int64_t samples_ = 0, dropped_ = 0, retired_bytes_ = 0;
  std::string event_;
};

}  // namespace framewatch::daemon
