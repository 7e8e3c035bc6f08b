#include "daemon/tools/replay/log_survey.h"

#include <numeric>

#include "drivers/lcm/accel_codec.h"

namespace framewatch::daemon {
namespace {

/// A larger jump is a node or a logger that was started anew, not a loss.
constexpr std::int64_t kMaxLost = 1'000'000;

/// newest - oldest - 1 when that is a plausible loss, else -1.
std::int64_t between(std::int64_t oldest, std::int64_t newest) {
  std::int64_t step = 0;
  if (__builtin_sub_overflow(newest, oldest, &step) || step < 1 || step > kMaxLost) return -1;
  return step - 1;
}

}  // namespace

void LogSurvey::intact(const drivers::LogEvent& event) {
  if (open_) {
    LostStretch& stretch = lost_.back();
    stretch.after_us = event.timestamp_us;
    if (stretch.places > 1)
      stretch.events = -1;
    else if (events_ > 0)
      stretch.events = between(last_number_, event.number);
    open_ = false;
  }
  ++events_;
  last_number_ = event.number;
  last_us_ = event.timestamp_us;
  count_samples(event);
}

void LogSurvey::count_samples(const drivers::LogEvent& event) {
  const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
  if (!sample) return;
  const auto [at, is_new] = nodes_.try_emplace({event.channel, sample->node});
  Node& node = at->second;
  if (!is_new && node.stretches < lost_.size()) {
    const std::int64_t missing = between(node.sequence, sample->sequence);
    if (missing > 0) lost_[node.stretches].samples[at->first] += missing;
  }
  node = {sample->sequence, lost_.size()};
}

void LogSurvey::damaged(const drivers::LogDamage& damage, bool truncated) {
  open_ = true;
  if (lost_.size() == kMaxStretches) {
    LostStretch& last = lost_.back();
    last.damage.bytes += damage.bytes;
    ++last.places;
    return;
  }
  LostStretch stretch;
  stretch.damage = damage;
  stretch.truncated = truncated;
  if (events_ > 0) stretch.before_us = last_us_;
  lost_.push_back(std::move(stretch));
}

std::int64_t LogSurvey::damaged_bytes() const {
  return std::accumulate(
      lost_.begin(), lost_.end(), std::int64_t{0},
      [](std::int64_t sum, const LostStretch& s) { return sum + s.damage.bytes; });
}

std::int64_t LogSurvey::damaged_places() const {
  return std::accumulate(lost_.begin(), lost_.end(), std::int64_t{0},
                         [](std::int64_t sum, const LostStretch& s) { return sum + s.places; });
}

}  // namespace framewatch::daemon
