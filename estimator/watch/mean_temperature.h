#pragma once

#include <array>
#include <cstdint>

#include "estimator/motion/sample.h"

namespace framewatch {

/// Means of a slow quantity over the last kBins stretches of equal length.
class MeanTemperature {
 public:
  static constexpr int kBins = 64;
  /// A reading holds for so many stretches when no other one comes.
  static constexpr int kHolds = 20;

  explicit MeanTemperature(double bin_s) : bin_us_(static_cast<std::int64_t>(1e6 * bin_s)) {}

  void push(Time time, double degc);
  /// Over the stretches that hold start to end; when there is nothing of them, of the newest one
  /// before that still holds; else NaN.
  double mean(Time start, Time end) const;

  template <typename Archive>
  void archive(Archive& a) {
    a(bins_);
  }

 private:
  struct Bin {
    std::int64_t number = -1, count = 0;
    double sum = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a(number, count, sum);
    }
  };
  std::int64_t number_of(Time time) const { return to_microseconds(time) / bin_us_; }

  std::int64_t bin_us_;
  std::array<Bin, kBins> bins_{};
};

}  // namespace framewatch
