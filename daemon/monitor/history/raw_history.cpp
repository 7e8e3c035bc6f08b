// SPDX-License-Identifier: MIT
#include "daemon/monitor/history/raw_history.h"

#include <cmath>
#include <utility>

#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {
namespace {

constexpr std::int64_t kBlock_us = 250'000;
constexpr std::size_t kBlockSamples = 4096;

}  // namespace

RawHistory::RawHistory(const Config& config, Retire retire, std::size_t queue_bytes)
    : config_(config),
      retire_(std::move(retire)),
      queue_bytes_(queue_bytes),
      block_(config.history->resolution_mps2) {}

void RawHistory::sample(const estimator::AccelSample& sample) {
  ++samples_;
  seconds_.passed(to_microseconds(sample.time));
  if (!block_.takes(sample)) end_block();
  block_.add(sample);
  const std::int64_t span_us = to_microseconds(sample.time) - block_.first_us();
  if (span_us >= kBlock_us || block_.size() >= kBlockSamples) end_block();
}

void RawHistory::message(const std::string& channel, std::int64_t time_us,
                         const std::vector<std::uint8_t>& bytes) {
  if (samples_ == 0) return;
  end_block();
  ready_log(time_us);
  append(channel, time_us, bytes, 0);
}

void RawHistory::tick(std::int64_t now_us) {
  ticked_us_ = now_us;
  if (log_ && log_->is_lost()) {
    end_block();
    rotate();
    lost_us_ = now_us;
  }
  if (block_.empty()) return;
  if (!block_since_us_) block_since_us_ = now_us;
  if (now_us - *block_since_us_ >= kBlock_us) end_block();
}

std::string RawHistory::trouble() const {
  if (lost_us_ && ticked_us_ - *lost_us_ < kTold_us)
    return "its log was moved, removed or replaced; a new one has begun";
  return log_ ? log_->trouble() : "";
}

void RawHistory::finish() {
  end_block();
  if (log_) rotate();
}

RawHistory::Counters RawHistory::counters() const {
  Counters out{samples_, dropped_, retired_bytes_, 0};
  if (!log_) return out;
  const drivers::DurableFile::Counters log = log_->counters();
  out.bytes += log.bytes;
  out.queued = log.queued;
  return out;
}

void RawHistory::end_block() {
  block_since_us_.reset();
  if (block_.empty()) return;
  const std::int64_t time_us = block_.first_us();
  ready_log(time_us);
  const std::size_t samples = block_.size();
  append(drivers::kCountsChannel, time_us, block_.encode(), samples);
}

void RawHistory::ready_log(std::int64_t time_us) {
  const auto rotate_us = static_cast<std::int64_t>(1e6 * config_.history->rotate_s);
  const std::int64_t slot = seconds_.newest_us() / rotate_us;
  const auto most_bytes = static_cast<std::int64_t>(1e6 * config_.history->rotate_mb);
  // While the disk fails, waiting data stays with the log that it belongs to.
  if (log_ && (slot != log_slot_ || log_bytes_ >= most_bytes) && log_->trouble().empty()) rotate();
  if (log_) return;
  log_ = std::make_unique<drivers::DurableFile>(queue_bytes_);
  log_->open_when_needed([directory = config_.history->directory, start_us = seconds_.newest_us()] {
    return new_raw_log(directory, start_us);
  });
  log_slot_ = slot;
  log_bytes_ = log_events_ = 0;
  append(drivers::kCountsTableChannel, time_us,
         drivers::count_table(axis_names(config_), config_.pipeline.options.rate_hz, time_us), 0);
}

void RawHistory::append(const std::string& channel, std::int64_t time_us,
                        const std::vector<std::uint8_t>& bytes, std::size_t samples) {
  event_.clear();
  // A missing number in the log marks a dropped block.
  drivers::append_log_event(event_, log_events_++, time_us, channel, bytes.data(), bytes.size());
  if (log_->append(event_))
    log_bytes_ += static_cast<std::int64_t>(event_.size());
  else
    dropped_ += static_cast<std::int64_t>(samples);
}

void RawHistory::rotate() {
  retired_bytes_ += log_->counters().bytes + static_cast<std::int64_t>(log_->counters().queued);
  retire_(std::move(log_));
}

}  // namespace framewatch::daemon
