#pragma once

#include <array>
#include <cstdint>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Means of the temperature over the last kBins intervals of equal length.
class MeanTemperature {
 public:
  static constexpr int kBins = 64;
  /// A reading is valid for so many intervals when no other one comes.
  static constexpr int kHolds = 20;

  explicit MeanTemperature(double bin_s) : bin_us_(static_cast<std::int64_t>(1e6 * bin_s)) {}

  void push(Time time, double degc);
  /// Over the intervals from start to end; when they hold no reading, of the newest valid one
  /// before; else NaN.
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
      for (std::int64_t* n : {&number, &count}) a.within(*n, -a.kMaxCount, a.kMaxCount);
      a.finite(sum);
    }
  };
  std::int64_t number_of(Time time) const { return to_microseconds(time) / bin_us_; }

  std::int64_t bin_us_;
  std::array<Bin, kBins> bins_{};
};

}  // namespace framewatch::estimator
