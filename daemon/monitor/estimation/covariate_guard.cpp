// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/covariate_guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace framewatch::daemon {
namespace {

constexpr double kDay_s = 86400;
constexpr std::int64_t kMostStamp_us = 4'000'000'000'000'000;  // differences do not overflow

double seconds_from(std::int64_t from_us, std::int64_t to_us) {
  return 1e-6 * static_cast<double>(to_us - from_us);
}

}  // namespace

CovariateGuard::CovariateGuard(const WeatherSettings& settings)
    : settings_(settings), unit_(*covariate_unit(settings.name)) {}

ReadingTrouble CovariateGuard::judge(std::int64_t time_us, double value,
                                     std::int64_t now_us) const {
  if (value < unit_.least || value > unit_.most) return ReadingTrouble::impossible;
  if (time_us > now_us + kMostAhead_us) return ReadingTrouble::future;
  if (time_us < now_us - kMostBehind_us) return ReadingTrouble::past;
  const bool heard_of_late = heard_us_ != 0 && std::abs(seconds_from(heard_us_, now_us)) < kDay_s;
  if (settled_ == kSettled && heard_of_late && trouble_ != ReadingTrouble::stuck &&
      std::abs(value - value_) > unit_.jump)
    return ReadingTrouble::jump;
  if (settings_.stuck_after_s > 0 && value == value_ &&
      seconds_from(same_us_, time_us) > settings_.stuck_after_s)
    return ReadingTrouble::stuck;
  return ReadingTrouble::none;
}

bool CovariateGuard::take(std::int64_t time_us, double value, std::int64_t now_us) {
  if (!std::isfinite(value)) return false;
  time_us = std::clamp(time_us, -kMostStamp_us, kMostStamp_us);
  now_us = std::clamp(now_us, -kMostStamp_us, kMostStamp_us);
  // Stamps that counted while the accelerometers' clock was ahead say nothing once it is right.
  if (value_us_ > now_us + kMostAhead_us) value_us_ = same_us_ = now_us - kLeast_us;
  if (value_us_ != 0 && time_us < value_us_ + kLeast_us && time_us >= now_us - kMostBehind_us)
    return false;
  const ReadingTrouble why = judge(time_us, value, now_us);
  heard_us_ = now_us;
  if (why != ReadingTrouble::none) {
    ++rejected_;
    refused_ = value;
    refused_us_ = time_us;
    good_ = 0;
    bad_ = std::min(bad_ + 1, kInARow);
    const bool free = trouble_ == ReadingTrouble::none || trouble_ == ReadingTrouble::away;
    if (bad_ == kInARow && free) begin(why, now_us);
    return false;
  }
  const bool far = std::abs(value - value_) > unit_.jump;
  settled_ = far ? 0 : std::min(settled_ + 1, kSettled);
  if (value != value_ || value_us_ == 0) same_us_ = time_us;
  value_ = value;
  value_us_ = mean_us_ = time_us;
  sum_ += value;
  ++count_;
  ++accepted_;
  bad_ = 0;
  good_ = std::min(good_ + 1, kInARow);
  if (good_ == kInARow || trouble_ == ReadingTrouble::away) begin(ReadingTrouble::none, now_us);
  return true;
}

void CovariateGuard::tell(std::int64_t now_us) {
  now_us = std::clamp(now_us, -kMostStamp_us, kMostStamp_us);
  std::int64_t last_us = value_us_ != 0 ? std::max(value_us_, begun_us_) : begun_us_;
  if (last_us == 0 || last_us > now_us + kMostAhead_us) last_us = begun_us_ = now_us;
  if (trouble_ != ReadingTrouble::none || seconds_from(last_us, now_us) <= settings_.away_after_s)
    return;
  begin(ReadingTrouble::away, now_us);
  trouble_us_ = last_us;
}

void CovariateGuard::begin(ReadingTrouble trouble, std::int64_t now_us) {
  if (trouble == trouble_) return;
  trouble_ = trouble;
  trouble_us_ = now_us;
}

CovariateGuard::Mean CovariateGuard::take_mean() {
  if (count_ == 0) return {};
  const Mean out{sum_ / count_, mean_us_};
  sum_ = 0;
  count_ = 0;
  return out;
}

}  // namespace framewatch::daemon
