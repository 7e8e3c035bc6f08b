// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace framewatch::drivers {

/// Resamples one axis of a free-running node to whole multiples of the grid's period. Weights 10
/// samples by a Kaiser-windowed sinc, which is linear in phase. The error is below 1e-4 of the
/// amplitude up to a fifth of the sampling rate. Fills a single missing sample by the cubic through
/// its neighbors; instants that need more missing samples have no value.
class Resampler {
 public:
  /// `time_us` is a multiple of the grid's period.
  using Sink = std::function<void(std::int64_t time_us, double value)>;

  explicit Resampler(double grid_period_us) : grid_us_(grid_period_us) {}

  /// Adds sample `number` of the node, taken at `time_us`; NaN stands for a missing one.
  /// `period_us` is the current time between samples. Calls `sink` for the instants that are now
  /// complete.
  void add(std::int64_t number, double time_us, double period_us, double value, const Sink& sink);
  /// Returns the number of samples filled so far.
  std::int64_t repaired() const { return repaired_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(ring_, started_, newest_, next_, repaired_);
  }

 private:
  static constexpr std::int64_t kHalf = 5;      ///< taps on each side
  static constexpr std::int64_t kPatience = 3;  ///< samples to wait for one that comes late
  static constexpr std::size_t kRing = 64;

  struct Slot {
    std::int64_t number = -1;
    double time_us = 0, value = 0;
    bool filled = false;

    template <typename Archive>
    void archive(Archive& a) {
      a(number, time_us, value, filled);
    }
  };
  Slot& slot(std::int64_t number) { return ring_[static_cast<std::size_t>(number) % kRing]; }
  bool has(std::int64_t number);
  bool fill(std::int64_t number);
  bool value_at(std::int64_t center, double fraction, double& value);

  double grid_us_;
  std::array<Slot, kRing> ring_{};
  bool started_ = false;
  std::int64_t newest_ = 0;
  std::int64_t next_ = 0;  ///< next instant, in grid periods
  std::int64_t repaired_ = 0;
};

}  // namespace framewatch::drivers
