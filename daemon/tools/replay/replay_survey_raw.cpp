#include <algorithm>
#include <utility>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/channel_table_t.hpp>

#include <fmt/core.h>

#include "daemon/tools/replay/replay_survey.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace

/// What is stored was taken by an intake before, so that only the log itself can be wrong.
void ReplaySurvey::look_at_counts(const drivers::LogEvent& event, LogSeen& seen) {
  seen.is_raw = any_raw_ = true;
  const auto give = [&](const estimator::AccelSample& sample) {
    const std::int64_t time_us = to_microseconds(sample.time);
    if (outside(time_us)) {
      seen.left_out = true;
      const bool before = static_cast<double>(time_us - span_zero_us_) * 1e-6 < span_.from_s;
      place_ = before ? Place::before : Place::after;
      return;
    }
    place_ = Place::inside;
    log_first_us_ = seen.samples == 0 ? time_us : std::min(log_first_us_, time_us);
    log_last_us_ = seen.samples == 0 ? time_us : std::max(log_last_us_, time_us);
    ++seen.samples;
    if (estimation_ != nullptr) estimation_->sample(sample);
  };
  const auto result = counts_.message(event.channel, event.data, give);
  if (result != drivers::IntakeResult::malformed) return;
  if (seen.malformed_counts++ > 0) return;
  seen.first_malformed_offset = event.offset;
  const bool is_table = event.channel == drivers::kCountsTableChannel;
  const bool whole = drivers::is_well_formed(
      event.data, is_table ? channel_table_t::getHash() : accel_counts_t::getHash());
  seen.malformed =
      event.channel + ": " +
      (!whole     ? drivers::why_not(is_table ? "channel_table_t" : "accel_counts_t", event.data)
       : is_table ? "names too many channels"
                  : "no table of its channels before it, or a resolution that is none");
}

void ReplaySurvey::judge_raw_log(const std::string& path, const LogSeen& seen) {
  if (seen.malformed_counts > 0) {
    const std::string text =
        fmt::format("{}: byte {}: {} messages are none of a raw log, the first: {}", path,
                    seen.first_malformed_offset, seen.malformed_counts, seen.malformed);
    if (seen.samples > 0)
      fault(text);
    else
      problems_.push_back(text);
  }
  if (seen.samples == 0 && seen.malformed_counts == 0 && !seen.left_out)
    problems_.push_back(fmt::format("{}: no channel is named like one of {}; it has {}", path,
                                    config_.path, joined(counts_.unknown())));
  else if (std::exchange(ignored_, joined(counts_.unknown())) != ignored_ && !ignored_.empty())
    notes_.push_back(fmt::format("{}: channels that {} does not have ignored: {}", path,
                                 config_.path, ignored_));
  if (seen.samples > 0) extend(path, log_first_us_, log_last_us_);
  if (counts_.rate_hz() > 0) check_rate(path, counts_.rate_hz());
}

}  // namespace framewatch::daemon
