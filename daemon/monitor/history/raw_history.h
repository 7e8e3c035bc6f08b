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

/// Writes raw samples into one log after the other, as integers (accel_counts_t). Never waits for
/// the disk: the thread of the log's DurableFile writes.
class RawHistory {
 public:
  static constexpr std::size_t kQueueBytes = std::size_t{32} << 20;
  /// Called with a log that is to be closed, which may take long.
  using Retire = std::function<void(std::unique_ptr<drivers::DurableFile>)>;

  struct Counters {
    std::int64_t samples = 0, dropped = 0;
    std::int64_t bytes = 0;  ///< written
    std::size_t queued = 0;  ///< bytes that wait
  };

  /// `config`, with its history, must outlive this.
  RawHistory(const Config& config, Retire retire, std::size_t queue_bytes = kQueueBytes);

  void sample(const estimator::AccelSample& sample);
  /// What belongs beside the samples, as it was received. Not stored before the first of them.
  void message(const std::string& channel, std::int64_t time_us,
               const std::vector<std::uint8_t>& bytes);
  /// Any clock that is never set, several times a second: what waits for its block to fill does not
  /// wait long.
  void tick(std::int64_t now_us);
  /// Writes what is collected to the log and passes the log to Retire.
  void finish();

  Counters counters() const;
  std::string trouble() const { return log_ ? log_->trouble() : ""; }
  std::int64_t newest_us() const { return seconds_.newest_us(); }

 private:
  void end_block();
  /// The log of now, with the channels' names.
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
  std::int64_t samples_ = 0, dropped_ = 0, retired_bytes_ = 0;
  std::string event_;
};

}  // namespace framewatch::daemon
