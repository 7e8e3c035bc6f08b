// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "daemon/config/keys/weather_options.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

/// Why readings of a covariate do not count.
enum class ReadingTrouble : std::int32_t {
  none,
  away,        ///< no valid reading for WeatherSettings::away_after_s
  impossible,  ///< outside the limits of the unit
  future,      ///< stamped ahead of the accelerometers' time
  past,        ///< stamped long before it
  jump,        ///< too far from the last reading: another unit, another sensor
  stuck,       ///< unchanged for WeatherSettings::stuck_after_s
};
inline constexpr int kReadingTroubles = 7;

/// Judges the readings of one covariate by their time and value. Uses sensor time only.
class CovariateGuard {
 public:
  static constexpr std::int64_t kMostAhead_us = 600'000'000, kMostBehind_us = 86'400'000'000;
  /// At most one reading in this time counts.
  static constexpr std::int64_t kLeast_us = 1'000'000;
  static constexpr int kSettled = 12;  ///< readings after which a jump is one
  static constexpr int kInARow = 3;    ///< readings that begin or end a trouble

  /// `settings` must outlive this; its name has a unit.
  explicit CovariateGuard(const WeatherSettings& settings);

  /// Takes a reading in the unit of the covariate. now_us: newest sample of the accelerometers.
  /// Returns true if it counts. Does not count, and does not reject, NaN and a reading that is not
  /// newer than the one before.
  bool take(std::int64_t time_us, double value, std::int64_t now_us);
  /// Tells the time. Call it once a second.
  void tell(std::int64_t now_us);

  /// Returns the trouble that lasts.
  ReadingTrouble trouble() const { return trouble_; }
  /// Returns since when it lasts, sensor time.
  std::int64_t trouble_since_us() const { return trouble_us_; }
  /// Returns the newest reading that was rejected, and its stamp.
  double refused() const { return refused_; }
  std::int64_t refused_us() const { return refused_us_; }

  double value() const { return value_; }                  ///< newest that counted; NaN: none
  std::int64_t value_us() const { return value_us_; }      ///< its stamp; 0: none
  std::int64_t same_since_us() const { return same_us_; }  ///< stamp of the first equal one
  /// Returns the sensor time at which the newest reading came, rejected or not; 0: none.
  std::int64_t heard_us() const { return heard_us_; }
  std::int64_t accepted() const { return accepted_; }
  std::int64_t rejected() const { return rejected_; }

  struct Mean {
    double value = estimator::kNaN;
    std::int64_t newest_us = 0;
  };
  /// Returns the mean of the readings that counted since the call before.
  Mean take_mean();

  template <typename Archive>
  void archive(Archive& a) {
    for (std::int64_t* us :
         {&value_us_, &heard_us_, &same_us_, &begun_us_, &trouble_us_, &refused_us_, &mean_us_})
      a.within(*us, -2 * a.kMaxCount, 2 * a.kMaxCount);
    for (std::int64_t* count : {&accepted_, &rejected_}) a.within(*count, 0, a.kMaxCount);
    for (int* few : {&settled_, &good_, &bad_}) a.within(*few, 0, kSettled);
    int trouble = static_cast<int>(trouble_);
    a.within(trouble, 0, kReadingTroubles - 1);
    trouble_ = static_cast<ReadingTrouble>(trouble);
    a(value_, refused_, sum_);
    a.within(count_, 0, 1'000'000);
  }

 private:
  ReadingTrouble judge(std::int64_t time_us, double value, std::int64_t now_us) const;
  void begin(ReadingTrouble trouble, std::int64_t now_us);

  const WeatherSettings& settings_;
  const CovariateUnit& unit_;
  double value_ = estimator::kNaN, refused_ = estimator::kNaN;
  std::int64_t value_us_ = 0, refused_us_ = 0;
  std::int64_t heard_us_ = 0;  ///< now_us of the newest reading, rejected or not; 0: none
  std::int64_t same_us_ = 0;
  std::int64_t begun_us_ = 0;  ///< first now_us; 0: none
  std::int64_t trouble_us_ = 0, mean_us_ = 0;
  std::int64_t accepted_ = 0, rejected_ = 0;
  int settled_ = 0, good_ = 0, bad_ = 0;  ///< in a row
  ReadingTrouble trouble_ = ReadingTrouble::none;
  double sum_ = 0;
  int count_ = 0;
};

}  // namespace framewatch::daemon
