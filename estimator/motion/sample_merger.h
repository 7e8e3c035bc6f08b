// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion/axis_counters.h"
#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Merges the axes' samples on one grid of instants. An instant is closed when every axis that is
/// not silent has delivered, or when a sample `lateness` newer has arrived, so a dead sensor does
/// not delay the others. Instants are returned in order; a jump of SampleSet::index is an
/// interruption. The grid's phase follows the time stamps, so it tolerates a sampling clock that is
/// off by 1000 ppm.
class SampleMerger {
 public:
  SampleMerger(int axes, double rate_hz, double lateness_s);

  /// Takes a sample. Bad samples are counted and dropped. Returns false if the sample is too new
  /// for the open instants: call next() until it returns nullptr, then push the sample again.
  [[nodiscard]] bool push(const AccelSample& sample);
  /// Returns the oldest instant that can be closed, or nullptr. An axis that did not deliver is
  /// NaN. The result is valid until the next call.
  const SampleSet* next();
  /// Lets next() return every open instant. Call it when no more samples will come.
  void finish() { finishing_ = true; }

  const std::vector<AxisCounters>& counters() const { return counters_; }
  AxisCounters& counters_of(int axis) { return counters_[static_cast<std::size_t>(axis)]; }

  void archive(auto& a) {
    a(open_);
    a.each_within(silent_, 0, 1);
    a.within(silent_count_, 0, static_cast<double>(silent_.size()));
    a(counters_, anchored_, finishing_);
    a.finite(phase_us_, stray_time_us_);
    for (std::int64_t* number : {&origin_, &first_open_}) a.within(*number, 0, a.kMaxCount);
    const auto ahead = static_cast<double>(open_.size() + static_cast<std::size_t>(lateness_));
    a.within(newest_, static_cast<double>(first_open_ - 1),
             static_cast<double>(first_open_) + ahead);
    a.within(strays_, 0, a.kMaxCount);
  }

 private:
  struct Instant {
    std::vector<double> accel;
    std::vector<std::uint8_t> has;
    int delivered = 0;

    void archive(auto& a) {
      a(accel);
      a.each_within(has, 0, 1);
      a.within(delivered, 0, static_cast<double>(has.size()));
    }
  };
  Instant& instant(std::int64_t index) {
    return open_[static_cast<std::size_t>(index % static_cast<std::int64_t>(open_.size()))];
  }
  std::int64_t index_of(double time_us) const;
  void anchor(double time_us);
  void stray(const AccelSample& sample);
  bool complete(const Instant& instant) const;
  void set_silent(std::size_t axis, bool silent);
  void clear(Instant& instant);

  double step_us_, steps_per_us_;
  std::int64_t lateness_;  ///< in instants
  int stray_limit_;
  std::vector<Instant> open_;
  std::vector<std::uint8_t> silent_;
  std::size_t silent_count_ = 0;
  std::vector<AxisCounters> counters_;
  bool anchored_ = false, finishing_ = false;
  double phase_us_ = 0;  ///< time of instant origin_
  std::int64_t origin_ = 0;
  std::int64_t first_open_ = 0, newest_ = -1;
  int strays_ = 0;
  double stray_time_us_ = 0;
  SampleSet set_;
};

}  // namespace framewatch::estimator
